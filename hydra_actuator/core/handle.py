# SPDX-License-Identifier: Apache-2.0
"""
Records of arrays and numbers that compiled code sees as one address.

A tuple of arrays goes into a compiled function as all its members, seven for each array; that
was most of the time of compilation, and of a call from Python. A Handle goes as the address of a
table: a number as it is, an array as its address and shape. The table never changes, so the
compiler may keep what it has read from it; what the arrays hold may change.
"""

from dataclasses import dataclass, fields
from functools import lru_cache
import hashlib
import operator

from llvmlite import ir
from numba import typeof
from numba.core import cgutils, types
from numba.core.datamodel.models import ArrayModel, OpaqueModel
from numba.core.imputils import lower_getattr_generic
from numba.core.typing.templates import AttributeTemplate, infer_getattr
from numba.extending import lower_builtin, NativeValue, register_model, unbox
from numba.np.arrayobj import make_array, populate_array
import numpy as np

WORD = 8


class HandleType(types.Type):
    """The type of a Handle: where in the table each field is, and its type."""

    def __init__(self, name: str, layout: dict) -> None:
        """Name the type by what tells it from others: record, fields and their types."""
        self.layout = layout
        told = hashlib.sha256(repr(layout).encode()).hexdigest()[:12]
        super().__init__(f'{name}_{told}')


@lru_cache
def _handle_type(name: str, places: tuple) -> HandleType:
    return HandleType(name, dict(places))


@dataclass(frozen=True, eq=False)
class Handle:
    """
    Base of such a record, a frozen dataclass of C-contiguous arrays, floats, ints and tuples.

    Of a tuple only the length is kept, in the type. A field of the record's own type, None until
    it is tied, leads to another such record.
    """

    def __post_init__(self) -> None:
        """Write the table."""
        places, words = [], []
        for field in fields(self):
            value = getattr(self, field.name)
            places.append((field.name, (len(words), _type_of(value))))
            words += _words(value)
        object.__setattr__(self, '_table', np.array(words, np.int64))
        object.__setattr__(self, '_address', self._table.ctypes.data)
        object.__setattr__(
            self, '_numba_type_', _handle_type(type(self).__name__, tuple(places)))

    def _tie(self, name: str, other: 'Handle') -> None:
        """Let a field lead to another record, for good."""
        self._table[self._numba_type_.layout[name][0]] = other._address
        object.__setattr__(self, name, other)

    def __reduce__(self):
        """Give a copy a table of its own."""
        values = (getattr(self, field.name) for field in fields(self))
        return type(self), tuple(None if isinstance(v, Handle) else v for v in values)


class HandleArray(types.Array):
    """
    The type of a one-dimensional array of numbers in a Handle, whose indices are never negative.

    Without this every index that is not proven otherwise costs a comparison, a selection and the
    array's size. An index of -1 reads what lies before the array, as in C.
    """

    def __init__(self, dtype: types.Type) -> None:
        """Name the type by that of its elements."""
        super().__init__(dtype, 1, 'C', name=f'HandleArray({dtype})')


register_model(HandleArray)(ArrayModel)


def _type_of(value: object) -> types.Type | None:
    if value is None or isinstance(value, Handle):
        return None
    if isinstance(value, tuple):
        return types.UniTuple(types.intp, len(value))
    if isinstance(value, float):
        return types.float64
    if isinstance(value, np.ndarray):
        return _array_type(value.dtype, value.ndim)
    return typeof(value)


@lru_cache
def _array_type(dtype: np.dtype, dimensions: int) -> types.Array:
    found = typeof(np.zeros((0,) * dimensions, dtype))
    if dimensions == 1 and isinstance(found.dtype, types.Number):
        return HandleArray(found.dtype)
    return found


def _words(value: object) -> list[int]:
    if value is None or isinstance(value, Handle):
        return [0 if value is None else value._address]
    if isinstance(value, tuple):
        return []
    if isinstance(value, np.ndarray):
        if not value.flags.c_contiguous:
            raise TypeError('a handle holds C-contiguous arrays')
        return [value.ctypes.data, *value.shape]
    return [int(np.float64(value).view(np.int64))] if isinstance(value, float) else [int(value)]


register_model(HandleType)(OpaqueModel)


@unbox(HandleType)
def _unbox(typ, handle, c):
    address = c.pyapi.object_getattr_string(handle, '_address')
    pointer = c.pyapi.long_as_voidptr(address)
    c.pyapi.decref(address)
    return NativeValue(pointer, is_error=cgutils.is_not_null(c.builder, c.pyapi.err_occurred()))


@infer_getattr
class _Attributes(AttributeTemplate):
    key = HandleType

    def generic_resolve(self, typ, attribute):
        place = typ.layout.get(attribute)
        if place is None:
            return None
        return typ if place[1] is None else place[1]


@lower_getattr_generic(HandleType)
def _read(context, builder, typ, address, attribute):
    word, field = typ.layout[attribute]
    field = typ if field is None else field
    if isinstance(field, types.UniTuple):
        return context.get_constant_undef(field)
    if isinstance(field, types.Array):
        return _array(context, builder, field, _load_words(builder, address, word, field.ndim))
    return _load(builder, address, word, context.get_value_type(field))


def _element(context, builder, signed, arguments):
    """Return the address of an element of a HandleArray."""
    array = make_array(signed.args[0])(context, builder, arguments[0])
    index = context.cast(builder, arguments[1], signed.args[1], types.intp)
    return builder.gep(array.data, [index])


@lower_builtin(operator.getitem, HandleArray, types.Integer)
def _get_item(context, builder, signed, arguments):
    place = _element(context, builder, signed, arguments)
    return context.unpack_value(builder, signed.args[0].dtype, place)


@lower_builtin(operator.setitem, HandleArray, types.Integer, types.Any)
def _set_item(context, builder, signed, arguments):
    place = _element(context, builder, signed, arguments)
    value = context.cast(builder, arguments[2], signed.args[2], signed.args[0].dtype)
    context.pack_value(builder, signed.args[0].dtype, value, place)
    return context.get_dummy_value()


def _array(context, builder, typ, words):
    """Return an array without owner over memory at words[0], of shape words[1:]."""
    size = ir.IntType(8 * WORD)
    itemsize = ir.Constant(size, context.get_abi_sizeof(context.get_data_type(typ.dtype)))
    shape, strides, stride = words[1:], [], itemsize
    for extent in reversed(shape):
        strides.insert(0, stride)
        stride = builder.mul(stride, extent)
    array = make_array(typ)(context, builder)
    data = builder.inttoptr(words[0], context.get_data_type(typ.dtype).as_pointer())
    populate_array(array, data=data, shape=shape, strides=strides, itemsize=itemsize, meminfo=None)
    return array._getvalue()


def _load_words(builder, address, word, dimensions):
    size = ir.IntType(8 * WORD)
    return [_load(builder, address, word + k, size) for k in range(dimensions + 1)]


def _load(builder, address, word, kind):
    place = builder.gep(address, [ir.Constant(ir.IntType(64), word * WORD)])
    value = builder.load(builder.bitcast(place, kind.as_pointer()))
    value.set_metadata('invariant.load', builder.module.add_metadata([]))
    return value
