# SPDX-License-Identifier: Apache-2.0
"""
The ends of the streamline: pump with relief valve and accumulator, tank, and plain ends.

Pump (Jankovic et al., equations 14, 15): supply pressure while the line takes at most
max_flow (the relief valve takes what is left and any backflow); at max_flow the pressure falls
out of the arriving wave. An accumulator at the pump holds gas at an absolute pressure
p V^1.4 = constant. Tank (16): constant pressure. Neglected: the pump's ripple and dynamics, the
relief valve's slope, inertia of the accumulator's neck, heat of the gas.
"""


from hydra_actuator.core.compilation import formula
from hydra_actuator.core.end import end_relation, velocity_at
from hydra_actuator.core.fluid import riemann_variable
from hydra_actuator.core.orifice import MOST_PASSES, settled

GAS_EXPONENT = 1.4
MOST_BRACKETED_PASSES = 60


@formula
def solve_pressure_end(end, pressure, held):
    """
    Return the outflow velocity [m/s] of an end held at a gauge pressure [Pa].

    held: the last such pressure and its mu [m/s], (2,), renewed in place: it seldom changes, and
    the logarithm is most of the work.
    """
    if pressure != held[0]:
        held[0] = pressure
        held[1] = riemann_variable(pressure, 1.0 / end.slowness, end.bulk_modulus)
    return velocity_at(end, held[1], pressure)


@formula
def solve_flow_end(end, flow):
    """Return the outflow velocity [m/s] of an end from which `flow` [m^3/s] leaves the line."""
    velocity = end.velocity
    for _ in range(MOST_PASSES):
        _, q, _, flatness = end_relation(end, velocity)
        change = (flow - q) * flatness
        velocity += change
        if settled(velocity, change):
            break
    return velocity


@formula
def solve_pump(end, source, oil_stored, step_time):
    """
    Return (outflow velocity [m/s], oil in the accumulator [m^3]) of the pump's end.

    source: SOURCE_PARAMETERS of hydra_actuator.core.records; max_flow 0 is unlimited.
    """
    free = velocity_at(end, source.mu, source.pressure)
    if source.max_flow == 0.0:
        return free, oil_stored
    if source.accumulator_volume > 0.0:
        return solve_accumulator(end, source, oil_stored, step_time)
    if -free * end.area * source.relative_density <= source.max_flow:
        return free, oil_stored
    return solve_flow_end(end, -source.max_flow), oil_stored


@formula
def stored_oil(pressure, source):
    """Return the oil [m^3] an accumulator holds at a gauge pressure [Pa], 0 below precharge."""
    ratio = (source.precharge + source.ambient) / (pressure + source.ambient)
    return max(0.0, source.accumulator_volume * (1.0 - ratio ** (1.0 / GAS_EXPONENT)))


@formula
def solve_accumulator(end, source, oil_stored, step_time):
    """
    Return (outflow velocity [m/s], oil stored [m^3]) with an accumulator beside the pump.

    The pump gives max_flow, the line draws q, the rest goes into the gas within the step
    (implicit, so stable at any gas stiffness); at supply pressure the relief valve opens.
    """
    free = velocity_at(end, source.mu, source.pressure)
    drawn = -free * end.area * source.relative_density
    full = stored_oil(source.pressure, source)
    if oil_stored + step_time * (source.max_flow - drawn) >= full:
        return free, full
    if oil_stored == 0.0:
        dry = solve_flow_end(end, -source.max_flow)
        if end_relation(end, dry)[0] <= source.precharge:
            return dry, 0.0
    low, high = free, fastest_outflow(end, source)
    velocity = min(max(end.velocity, low), high)
    # stored(p) - oil - dt (max_flow - drawn) falls as v rises: Newton inside a bracket
    for _ in range(MOST_BRACKETED_PASSES):
        p, q, z, flatness = end_relation(end, velocity)
        held = stored_oil(p, source)
        residual = held - oil_stored - step_time * (source.max_flow + q)
        if residual > 0.0:
            low = velocity
        else:
            high = velocity
        softness = 0.0
        if held > 0.0:
            softness = (source.accumulator_volume - held) / (
                GAS_EXPONENT * (p + source.ambient))
        trial = velocity + residual * flatness / (step_time + z * softness)
        if not low <= trial <= high:
            trial = 0.5 * (low + high)
        change = trial - velocity
        velocity = trial
        if settled(velocity, change):
            break
    q = end_relation(end, velocity)[1]
    return velocity, max(0.0, oil_stored + step_time * (source.max_flow + q))


@formula
def fastest_outflow(end, source):
    """Return the outflow velocity [m/s] just above absolute vacuum, where the gas law ends."""
    depth = source.ambient
    if end.strength > 0.0:
        depth = min(depth, end.floor)
    mu = riemann_variable(-0.999 * depth, 1.0 / end.slowness, end.bulk_modulus)
    return velocity_at(end, mu, -0.999 * depth)
