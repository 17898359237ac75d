# SPDX-License-Identifier: Apache-2.0
"""Choices in lanes, what a branch is for one number; see hydra_actuator.core.lanes."""

from hydra_actuator.core.lanes import in_all_lanes, LANES, VECTOR, WIDTH
from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic


@intrinsic
def where_positive(typing_context, lanes, then, otherwise):
    """Return `then` in the lanes that are above 0, `otherwise` in the others and where NaN is."""
    def generate(context, builder, signed, arguments):
        zero = ir.Constant(VECTOR, [0.0] * WIDTH)
        above = builder.fcmp_ordered('>', arguments[0], zero)
        return builder.select(above, arguments[1], arguments[2])
    return LANES(LANES, LANES, LANES), generate


@intrinsic
def where_at_most(typing_context, lanes, limit, then, otherwise):
    """Return `then` in the lanes that are at most the limit, `otherwise` elsewhere and at NaN."""
    def generate(context, builder, signed, arguments):
        inside = builder.fcmp_ordered('<=', arguments[0], arguments[1])
        return builder.select(inside, arguments[2], arguments[3])
    return LANES(LANES, LANES, LANES, LANES), generate


@intrinsic
def all_at_most(typing_context, lanes, limit):
    """Return whether every lane is at most the limit, a float or lanes; no NaN is."""
    def generate(context, builder, signed, arguments):
        most = arguments[1] if limit is LANES else in_all_lanes(builder, arguments[1])
        beyond = builder.fcmp_unordered('>', arguments[0], most)
        bits = builder.bitcast(beyond, ir.IntType(WIDTH))
        return builder.icmp_unsigned('==', bits, ir.Constant(ir.IntType(WIDTH), 0))
    return types.boolean(LANES, limit), generate


@intrinsic
def at_most(typing_context, lanes, limit):
    """Return the lanes, or the limit (a float or lanes) where they are not below it."""
    return LANES(LANES, limit), _limited('<')


@intrinsic
def at_least(typing_context, lanes, limit):
    """Return the lanes, or the limit (a float or lanes) where they are not above it."""
    return LANES(LANES, limit), _limited('>')


def _limited(comparison):
    def generate(context, builder, signed, arguments):
        lanes, limit = arguments
        if signed.args[1] is not LANES:
            limit = in_all_lanes(builder, limit)
        inside = builder.fcmp_ordered(comparison, lanes, limit)
        return builder.select(inside, lanes, limit)
    return generate
