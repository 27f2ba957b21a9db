/* The entries as functions of Python: objects are taken as an entry expects them. */

#define PY_SSIZE_T_CLEAN
#define Py_LIMITED_API 0x030B0000
#define NPY_NO_DEPRECATED_API NPY_1_20_API_VERSION
#include <Python.h>
#include <stdlib.h>
#include <string.h>
#include <numpy/arrayobject.h>
#include "kernels.h"

static const Entries *entries;

/* What an entry takes: a number (float, int or bool), an array, or a tuple, whose items follow.
 * A length is a number more than one that has a name; the first name is that of zero, the second
 * that of the poses. */
typedef struct {
    const char *text;
    char number;
    int count, kind;
    npy_intp bytes;
    struct { int name, more; } lengths[4];
} Expected;

typedef union {
    double real;
    int whole;
    void *array;
} Given;

static int refuse(const Expected *e, PyObject *error)
{
    PyErr_SetString(error, e->text);
    return 0;
}

static int is_number(PyObject *given, char kind, Given *to)
{
    if (kind == 'f') {
        to->real = PyFloat_AsDouble(given);
        return to->real != -1.0 || !PyErr_Occurred();
    }
    const long whole = kind == 'i' ? PyLong_AsLong(given) : PyObject_IsTrue(given);
    to->whole = (int)whole;
    return to->whole == whole && (whole != -1 || !PyErr_Occurred());
}

/* Whether the lengths of an array are those expected; a name without a value gets one. */
static int fits(PyArrayObject *array, const Expected *e, npy_intp *lengths)
{
    for (int k = 0; k < e->count; k++) {
        const npy_intp rest = PyArray_DIM(array, k) - e->lengths[k].more;
        npy_intp *length = lengths + e->lengths[k].name;
        if (*length < 0) {
            *length = rest;
        }
        if (rest < 0 || rest != *length) {
            return 0;
        }
    }
    return 1;
}

/* Take what is given, or set an error. */
static int take(PyObject *given, const Expected **next, Given **to, npy_intp *lengths)
{
    const Expected *e = (*next)++;
    PyArrayObject *array = (PyArrayObject *)given;
    if (e->number) {
        return is_number(given, e->number, (*to)++) || refuse(e, PyExc_TypeError);
    }
    if (e->bytes) {
        if (!PyArray_Check(given) || PyArray_TYPE(array) != e->kind ||
            PyArray_ITEMSIZE(array) != e->bytes || PyArray_NDIM(array) != e->count ||
            !PyArray_IS_C_CONTIGUOUS(array)) {
            return refuse(e, PyExc_TypeError);
        }
        (*to)++->array = PyArray_DATA(array);
        return fits(array, e, lengths) || refuse(e, PyExc_ValueError);
    }
    if (PyTuple_Size(given) != e->count) {
        return refuse(e, PyExc_TypeError);
    }
    int taken = 1;
    for (int i = 0; taken && i < e->count; i++) {
        taken = take(PyTuple_GetItem(given, i), next, to, lengths);
    }
    return taken;
}

/* An entry: how many parameters it has, numbers and arrays in them, and lengths; what is expected,
 * and its call with what was taken, during which others run if poses are as many or more. */
typedef struct {
    const char *name;
    Py_ssize_t parameters;
    int values, names;
    const Expected *expected;
    PyObject *(*call)(const npy_intp *lengths, const Given *given, npy_intp many);
} Door;

/* Take all arguments of an entry. */
static int take_all(
    const Door *door, PyObject *const *args, Py_ssize_t count, Given *to, npy_intp *lengths)
{
    if (count != door->parameters) {
        PyErr_Format(PyExc_TypeError, "expected %zd arguments, got %zd", door->parameters, count);
        return 0;
    }
    for (int k = 0; k < door->names; k++) {
        lengths[k] = k == 0 ? 0 : -1;
    }
    const Expected *next = door->expected;
    int taken = 1;
    for (Py_ssize_t i = 0; taken && i < count; i++) {
        taken = take(args[i], &next, &to, lengths);
    }
    return taken;
}

/* Poses of a call from which on other threads may run meanwhile. */
#define MANY 64

#define DOOR(public, entry, parameters, values, names, run, answer, ...) \
static PyObject *call_##entry(const npy_intp *lengths, const Given *given, npy_intp many) \
{ \
    PyThreadState *others = lengths[1] >= many ? PyEval_SaveThread() : NULL; \
    run; \
    entries->leave(); \
    if (others) { \
        PyEval_RestoreThread(others); \
    } \
    return answer; \
} \
static const Expected expected_##entry[] = {__VA_ARGS__}; \
static const Door door_##entry = { \
    #public, parameters, values, names, expected_##entry, call_##entry}; \
static PyObject *py_##entry(PyObject *self, PyObject *const *args, Py_ssize_t count) \
{ \
    npy_intp lengths[names]; \
    Given given[values]; \
    (void)self; \
    const int taken = take_all(&door_##entry, args, count, given, lengths); \
    return taken ? call_##entry(lengths, given, MANY) : NULL; \
}
#include "doors.h"
#undef DOOR

#define DOOR(public, entry, ...) &door_##entry,
static const Door *const doors[] = {
#include "doors.h"
    NULL,
};
#undef DOOR

#include "at_once.c"

/* By names that pickle takes. */
#define DOOR(public, entry, ...) \
    {#public, (PyCFunction)(void (*)(void))py_##entry, METH_FASTCALL, NULL},
static PyMethodDef methods[] = {
#include "doors.h"
    {"at_once", at_once, METH_VARARGS, NULL},
    {NULL, NULL, 0, NULL},
};

/* The same kernels for processors that have something. */
typedef struct {
    const char *name;
    int (*has)(void);
    const Entries *entries;
} Level;

extern const Entries entries_any;
int has_any(void) { return 1; }

#ifdef __x86_64__
#include <cpuid.h>
extern const Entries entries_v4, entries_v3;

/* Whether the processor has these bits of registers c and b, and the system keeps that state of its
 * registers. The compilers' own question, __builtin_cpu_supports, has no answer where the compiler
 * is that of the wheel. */
static int has(unsigned c1, unsigned b7, unsigned state)
{
    unsigned a, b, c, d, kept, more;
    if (!__get_cpuid(1, &a, &b, &c, &d) || (c & c1) != c1) {
        return 0;
    }
    __asm__("xgetbv" : "=a"(kept), "=d"(more) : "c"(0));
    return (kept & state) == state && __get_cpuid_count(7, 0, &a, &b, &c, &d) && (b & b7) == b7;
}

#define C1 (bit_OSXSAVE | bit_AVX | bit_FMA)
#define V3 (bit_AVX2 | bit_BMI | bit_BMI2)
#define V4 (V3 | bit_AVX512F | bit_AVX512CD | bit_AVX512BW | bit_AVX512DQ | bit_AVX512VL)
int has_v3(void) { return has(C1, V3, 0x06); }
int has_v4(void) { return has(C1, V4, 0xe6); }
#define OTHERS {"v4", has_v4, &entries_v4}, {"v3", has_v3, &entries_v3},
#define NAMES "v4, v3, any"
#else
#define OTHERS
#define NAMES "any"
#endif

/* Best first. */
static const Level levels[] = {OTHERS {"any", has_any, &entries_any}, {NULL, NULL, NULL}};

static struct PyModuleDef definition = {
    PyModuleDef_HEAD_INIT, "_kernels", NULL, -1, methods, NULL, NULL, NULL, NULL,
};

/* The module, with the entries of the best level that the processor has, or of the one wanted. */
PyMODINIT_FUNC PyInit__kernels(void)
{
    import_array();
    const char *wanted = getenv("DH2URDF_LEVEL");
    const int any = !wanted || !*wanted;
    const Level *level = levels;
    while (level->name && !(level->has() && (any || !strcmp(wanted, level->name)))) {
        level++;
    }
    if (!level->name) {
        return PyErr_Format(PyExc_ValueError,
            "DH2URDF_LEVEL: expected one of " NAMES " that this processor has, got %s", wanted);
    }
    entries = level->entries;
    PyObject *module = PyModule_Create(&definition);
    if (module && (PyModule_AddStringConstant(module, "SOURCES", SOURCES) < 0
            || PyModule_AddStringConstant(module, "COMPILER", __VERSION__) < 0
            || PyModule_AddStringConstant(module, "LEVEL", level->name) < 0)) {
        Py_DECREF(module);
        return NULL;
    }
    return module;
}
