# SPDX-License-Identifier: Apache-2.0
"""
Four neighbouring nodes as one value, so that a loop over nodes is vector code by its making.

A compiler makes vector code of a plain loop only where it can prove, or check at each entry, that
no array overlaps another, and has a second loop for what is left over; for the short domains of a
chain that cost a quarter of the sweep. `load` and `store` move WIDTH doubles from and to an array
at an index, which must not be negative, without a check; +, -, *, /, abs and sqrt work lane by
lane, a float stands in all lanes. Processors with shorter vectors get two or four operations for
one. Each lane has the bits that the same formula gives with floats.
"""

import math
import operator

from hydra_actuator.core.compilation import formula
from llvmlite import ir
from numba.core import types
from numba.core.datamodel.models import PrimitiveModel
from numba.core.typing.templates import ConcreteTemplate, infer_global, signature
from numba.extending import intrinsic, lower_builtin, register_model
from numba.np.arrayobj import make_array

WIDTH = 4

VECTOR = ir.VectorType(ir.DoubleType(), WIDTH)
_OPERATIONS = (
    (operator.add, 'fadd'), (operator.iadd, 'fadd'), (operator.sub, 'fsub'),
    (operator.isub, 'fsub'), (operator.mul, 'fmul'), (operator.truediv, 'fdiv'))


class _LanesType(types.Type):
    """The type of WIDTH doubles side by side."""

    def __init__(self) -> None:
        super().__init__('Lanes')


LANES = _LanesType()


@register_model(_LanesType)
class _LanesModel(PrimitiveModel):

    def __init__(self, manager, front_end_type) -> None:
        super().__init__(manager, front_end_type, VECTOR)


def in_all_lanes(builder, value):
    """Return, as code, a vector with a value in every lane."""
    nothing = ir.Constant(VECTOR, ir.Undefined)
    index = ir.IntType(32)
    first = builder.insert_element(nothing, value, ir.Constant(index, 0))
    return builder.shuffle_vector(
        first, nothing, ir.Constant(ir.VectorType(index, WIDTH), [0] * WIDTH))


def _define(operation, instruction) -> None:
    kinds = ((LANES, LANES), (LANES, types.float64), (types.float64, LANES))

    @infer_global(operation)
    class _Template(ConcreteTemplate):
        cases = [signature(LANES, *kind) for kind in kinds]

    def lower(context, builder, signed, arguments):
        values = (value if kind is LANES else in_all_lanes(builder, value)
                  for value, kind in zip(arguments, signed.args))
        return getattr(builder, instruction)(*values)

    for kind in kinds:
        lower_builtin(operation, *kind)(lower)


for _operation, _instruction in _OPERATIONS:
    _define(_operation, _instruction)


def _define_function(function, name) -> None:
    @infer_global(function)
    class _Template(ConcreteTemplate):
        cases = [signature(LANES, LANES)]

    @lower_builtin(function, LANES)
    def _lower(context, builder, signed, arguments):
        return builder.call(_declared(builder.module, name), arguments)


def _declared(module, name, operands=1):
    name = f'llvm.{name}.v{WIDTH}f64'
    known = module.globals.get(name)
    return known or ir.Function(module, ir.FunctionType(VECTOR, [VECTOR] * operands), name)


_define_function(abs, 'fabs')
_define_function(math.sqrt, 'sqrt')


@infer_global(operator.neg)
class _Negation(ConcreteTemplate):
    cases = [signature(LANES, LANES)]


@lower_builtin(operator.neg, LANES)
def _negate(context, builder, signed, arguments):
    return builder.fneg(arguments[0])


@infer_global(math.copysign)
class _Copysign(ConcreteTemplate):
    cases = [signature(LANES, LANES, LANES)]


@lower_builtin(math.copysign, LANES, LANES)
def _copy_sign(context, builder, signed, arguments):
    return builder.call(_declared(builder.module, 'copysign', 2), arguments)


def _place(context, builder, signed, arguments):
    array = make_array(signed.args[0])(context, builder, arguments[0])
    index = context.cast(builder, arguments[1], signed.args[1], types.intp)
    return builder.bitcast(builder.gep(array.data, [index]), VECTOR.as_pointer())


@intrinsic
def load(typing_context, array, index):
    """Return the WIDTH values of a C-contiguous array of doubles from `index` on."""
    def generate(context, builder, signed, arguments):
        return builder.load(_place(context, builder, signed, arguments), align=8)
    return LANES(array, index), generate


@intrinsic
def store(typing_context, array, index, lanes):
    """Write lanes into a C-contiguous array of doubles from `index` on."""
    def generate(context, builder, signed, arguments):
        builder.store(arguments[2], _place(context, builder, signed, arguments), align=8)
        return context.get_dummy_value()
    return types.void(array, index, LANES), generate


@intrinsic
def multiply_add(typing_context, a, b, c):
    """
    Return a b + c of floats or of lanes, rounded once where the processor can.

    Where both sides of a sum are products the compiler is free which to fuse; this says which.
    """
    kind = VECTOR if a is LANES else ir.DoubleType()

    def generate(context, builder, signed, arguments):
        name = f'llvm.fmuladd.{f"v{WIDTH}f64" if a is LANES else "f64"}'
        known = builder.module.globals.get(name)
        return builder.call(
            known or ir.Function(builder.module, ir.FunctionType(kind, [kind] * 3), name),
            arguments)
    return a(a, a, a), generate


@intrinsic
def gather(typing_context, array, indices, first, shift):
    """Return the doubles array[indices[first + l] + shift], lane by lane; none below 0."""
    def generate(context, builder, signed, arguments):
        lanes = ir.Constant(VECTOR, ir.Undefined)
        for k, place in enumerate(_places(context, builder, signed, arguments)):
            lane = ir.Constant(ir.IntType(32), k)
            lanes = builder.insert_element(lanes, builder.load(place), lane)
        return lanes
    return LANES(array, indices, types.intp, types.intp), generate


@intrinsic
def scatter(typing_context, array, indices, first, shift, lanes):
    """Write the lanes to array[indices[first + l] + shift]."""
    def generate(context, builder, signed, arguments):
        for k, place in enumerate(_places(context, builder, signed, arguments)):
            lane = ir.Constant(ir.IntType(32), k)
            builder.store(builder.extract_element(arguments[4], lane), place)
        return context.get_dummy_value()
    return types.void(array, indices, types.intp, types.intp, LANES), generate


def _places(context, builder, signed, arguments):
    """Return the addresses that `gather` and `scatter` go to."""
    array, indices, first, shift = arguments[:4]
    data = make_array(signed.args[0])(context, builder, array).data
    indices = make_array(signed.args[1])(context, builder, indices).data
    start = builder.gep(indices, [first])
    places = []
    for k in range(WIDTH):
        index = builder.load(builder.gep(start, [ir.Constant(ir.IntType(64), k)]))
        places.append(builder.gep(data, [builder.add(index, shift)]))
    return places


def _chosen(builder, one, other, places):
    mask = ir.Constant(ir.VectorType(ir.IntType(32), len(places)), list(places))
    return builder.shuffle_vector(one, other, mask)


@intrinsic
def look_up(typing_context, table, start, places):
    """
    Return (value at the place rounded down, the next, what was rounded off), lane by lane.

    table: C-contiguous doubles, of which places count from `start`; places must not be negative.
    """
    def generate(context, builder, signed, arguments):
        entries, first, places = arguments
        array = make_array(signed.args[0])(context, builder, entries)
        data = builder.gep(array.data, [first])
        counts = ir.VectorType(ir.IntType(32), WIDTH)
        whole = builder.fptosi(places, counts)
        pair = ir.VectorType(ir.DoubleType(), 2)
        pairs = []
        for k in range(WIDTH):
            lane = ir.Constant(ir.IntType(32), k)
            index = builder.zext(builder.extract_element(whole, lane), ir.IntType(64))
            place = builder.bitcast(builder.gep(data, [index]), pair.as_pointer())
            pairs.append(builder.load(place, align=8))
        # a pair from each half beside the other, so that the halves of a vector keep their places
        even = _chosen(builder, pairs[0], pairs[2], (0, 1, 2, 3))
        odd = _chosen(builder, pairs[1], pairs[3], (0, 1, 2, 3))
        low = _chosen(builder, even, odd, (0, 4, 2, 6))
        high = _chosen(builder, even, odd, (1, 5, 3, 7))
        rest = builder.fsub(places, builder.sitofp(whole, VECTOR))
        return context.make_tuple(builder, signed.return_type, (low, high, rest))
    return types.UniTuple(LANES, 3)(table, types.intp, LANES), generate


@formula
def element(values, e):
    """Return the lanes of element e of an array in which each element stands WIDTH times."""
    return load(values, WIDTH * e)


@formula
def put(values, e, lanes):
    """Write the lanes of one element."""
    store(values, WIDTH * e, lanes)
