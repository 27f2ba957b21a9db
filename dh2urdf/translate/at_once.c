/* A pose solved in one call from Python: entries one after the other, on arguments taken once. */

/* An entry with its arguments, and whether it has to answer something, or zero or nothing. */
typedef struct {
    const Door *door;
    int wanted;
    npy_intp *lengths;
    Given *given;
} Step;

/* The steps, and the memory that they share, of which the pose is the beginning and a copy the
 * answer; the tuple of arrays to which numbers go that are given with the pose. */
typedef struct {
    PyObject *kept, *memory, *more;
    Py_ssize_t count;
    Step *steps;
} Steps;

static void forget(PyObject *capsule)
{
    Steps *all = PyCapsule_GetPointer(capsule, NULL);
    for (Py_ssize_t i = 0; all->steps && i < all->count; i++) {
        free(all->steps[i].lengths);
        free(all->steps[i].given);
    }
    Py_DECREF(all->kept);
    free(all->steps);
    free(all);
}

/* Copy a pose, if it is an array of the usual kind in any order of its numbers. */
static int copy_pose(PyObject *T, char *to)
{
    PyArrayObject *array = (PyArrayObject *)T;
    if (!PyArray_CheckExact(T) || PyArray_TYPE(array) != NPY_DOUBLE || PyArray_NDIM(array) != 2 ||
        PyArray_DIM(array, 0) != 4 || PyArray_DIM(array, 1) != 4 || !PyArray_ISNOTSWAPPED(array)) {
        return 0;
    }
    const char *from = PyArray_BYTES(array);
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++, to += 8) {
            memcpy(to, from + i * PyArray_STRIDE(array, 0) + j * PyArray_STRIDE(array, 1), 8);
        }
    }
    return 1;
}

/* Copy a number, or an array or list of as many as there is room for, of the usual kinds. */
static int copy_numbers(PyObject *given, PyArrayObject *room)
{
    double *to = PyArray_DATA(room);
    const npy_intp count = PyArray_SIZE(room);
    if (PyFloat_CheckExact(given)) {
        *to = PyFloat_AsDouble(given);
        return count == 1;
    }
    if (PyList_CheckExact(given) && PyList_Size(given) == count) {
        for (npy_intp i = 0; i < count; i++) {
            PyObject *number = PyList_GetItem(given, i);
            if (!PyFloat_CheckExact(number)) {
                return 0;
            }
            to[i] = PyFloat_AsDouble(number);
        }
        return 1;
    }
    PyArrayObject *array = (PyArrayObject *)given;
    if (!PyArray_CheckExact(given) || PyArray_TYPE(array) != NPY_DOUBLE ||
        PyArray_NDIM(array) != 1 || PyArray_DIM(array, 0) != count ||
        !PyArray_ISNOTSWAPPED(array)) {
        return 0;
    }
    for (npy_intp i = 0; i < count; i++) {
        memcpy(to + i, PyArray_BYTES(array) + i * PyArray_STRIDE(array, 0), 8);
    }
    return 1;
}

/* The memory after all steps, or None where one of them answers something else. No other thread
 * runs meanwhile: the memory is that of all threads. */
static PyObject *solve(PyObject *capsule, PyObject *const *args, Py_ssize_t count)
{
    const Steps *all = PyCapsule_GetPointer(capsule, NULL);
    PyArrayObject *memory = (PyArrayObject *)all->memory;
    if (count != 1 + PyTuple_Size(all->more)) {
        PyErr_SetString(PyExc_TypeError, "at_once: a pose, and numbers for which there is room");
        return NULL;
    }
    int go_on = copy_pose(args[0], PyArray_BYTES(memory));
    for (Py_ssize_t i = 1; go_on && i < count; i++) {
        go_on = copy_numbers(args[i], (PyArrayObject *)PyTuple_GetItem(all->more, i - 1));
    }
    for (Py_ssize_t i = 0; go_on && i < all->count; i++) {
        const Step *step = all->steps + i;
        PyObject *found = step->door->call(step->lengths, step->given, NPY_MAX_INTP);
        if (!found) {
            return NULL;
        }
        go_on = PyObject_IsTrue(found) == step->wanted;
        Py_DECREF(found);
    }
    if (!go_on) {
        return Py_NewRef(Py_None);
    }
    return PyBytes_FromStringAndSize(PyArray_BYTES(memory), PyArray_NBYTES(memory));
}

/* Take the arguments of a step: an entry's name, a tuple of its arguments, what it has to answer.
 */
static int prepare(PyObject *given, Step *step)
{
    PyObject *args, *items[16];
    const char *name;
    if (!PyArg_ParseTuple(given, "sO!p", &name, &PyTuple_Type, &args, &step->wanted)) {
        return 0;
    }
    const Door *const *door = doors;
    while (*door && strcmp((*door)->name, name)) {
        door++;
    }
    const Py_ssize_t count = PyTuple_Size(args);
    if (!*door || count > 16) {
        PyErr_SetString(PyExc_ValueError, "at_once: no such entry");
        return 0;
    }
    for (Py_ssize_t i = 0; i < count; i++) {
        items[i] = PyTuple_GetItem(args, i);
    }
    step->door = *door;
    step->lengths = calloc((*door)->names, sizeof *step->lengths);
    step->given = calloc((*door)->values, sizeof *step->given);
    if (!step->lengths || !step->given) {
        PyErr_NoMemory();
        return 0;
    }
    return take_all(*door, items, count, step->given, step->lengths);
}

/* at_once(memory, more, steps): the function of a pose, and of numbers for each array of the tuple
 * more, that goes through the steps. All arrays of their arguments are in these two, or in what the
 * caller does not change. */
static PyObject *at_once(PyObject *self, PyObject *args)
{
    static PyMethodDef method = {"solve", (PyCFunction)(void (*)(void))solve, METH_FASTCALL, NULL};
    PyObject *memory, *more, *given;
    (void)self;
    if (!PyArg_ParseTuple(args, "O!O!O!", &PyArray_Type, &memory, &PyTuple_Type, &more, &PyTuple_Type,
                          &given)) {
        return NULL;
    }
    Steps *all = calloc(1, sizeof *all);
    Step *steps = calloc(PyTuple_Size(given), sizeof *steps);
    if (!all || !steps) {
        free(all);
        free(steps);
        return PyErr_NoMemory();
    }
    *all = (Steps){Py_NewRef(args), memory, more, PyTuple_Size(given), steps};
    PyObject *capsule = PyCapsule_New(all, NULL, forget);
    for (Py_ssize_t i = 0; capsule && i < all->count; i++) {
        if (!prepare(PyTuple_GetItem(given, i), steps + i)) {
            Py_DECREF(capsule);
            return NULL;
        }
    }
    PyObject *function = capsule ? PyCFunction_NewEx(&method, capsule, NULL) : NULL;
    Py_XDECREF(capsule);
    return function;
}
