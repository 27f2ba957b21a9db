/* What the doors share: objects of Python are taken as an entry expects them. */

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
 * A length is a number more than one that has a name; the first name is that of zero. */
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

/* Take all arguments of an entry. */
static int take_all(PyObject *const *args, Py_ssize_t count, Py_ssize_t parameters,
    const Expected *next, Given *to, npy_intp *lengths)
{
    if (count != parameters) {
        PyErr_Format(PyExc_TypeError, "expected %zd arguments, got %zd", parameters, count);
        return 0;
    }
    int taken = 1;
    for (Py_ssize_t i = 0; taken && i < count; i++) {
        taken = take(args[i], &next, &to, lengths);
    }
    return taken;
}

/* The same kernels for processors that have something: best first. */
typedef struct {
    const char *name;
    int has;
    const Entries *entries;
} Level;

/* The module, with the entries of the best level that the processor has, or of the one wanted. */
static PyObject *made(struct PyModuleDef *definition, const Level *level, const char *names,
    const char *sources)
{
    const char *wanted = getenv("DH2URDF_LEVEL");
    const int any = !wanted || !*wanted;
    while (level->name && !(level->has && (any || !strcmp(wanted, level->name)))) {
        level++;
    }
    if (!level->name) {
        PyErr_Format(PyExc_ValueError, "DH2URDF_LEVEL: expected one of %s that this processor has, "
            "got %s", names, wanted);
        return NULL;
    }
    entries = level->entries;
    PyObject *module = PyModule_Create(definition);
    if (module && (PyModule_AddStringConstant(module, "SOURCES", sources) < 0
            || PyModule_AddStringConstant(module, "COMPILER", __VERSION__) < 0
            || PyModule_AddStringConstant(module, "LEVEL", level->name) < 0)) {
        Py_DECREF(module);
        return NULL;
    }
    return module;
}
