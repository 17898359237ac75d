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
from hydra_actuator.core.fluid import end_relation, relative_compression, riemann_variable
from hydra_actuator.core.orifice import MOST_PASSES, VELOCITY_TOLERANCE

GAS_EXPONENT = 1.4


@formula
def solve_pressure_end(wave, mu):
    """Return the outflow velocity [m/s] of an end held at the Riemann variable mu [m/s]."""
    return wave - mu


@formula
def solve_flow_end(end, flow):
    """Return the outflow velocity [m/s] of an end from which `flow` [m^3/s] leaves the line."""
    wave, velocity, wave_speed, bulk_modulus, area = end
    for _ in range(MOST_PASSES):
        _, q, _, slope = end_relation(wave, velocity, wave_speed, bulk_modulus, area)
        change = (flow - q) / slope
        velocity += change
        if abs(change) < VELOCITY_TOLERANCE * wave_speed:
            break
    return velocity


@formula
def solve_pump(end, source, oil_stored, step_time):
    """
    Return (outflow velocity [m/s], oil in the accumulator [m^3]) of the pump's end.

    source: record of pressure and its mu, max_flow (0 = unlimited) and accumulator.
    """
    wave, velocity, wave_speed, bulk_modulus, area = end
    free = wave - source.mu
    relative_density = 1.0 + source.pressure / bulk_modulus
    drawn = -free * area * relative_density
    if source.max_flow == 0.0:
        return free, oil_stored
    if source.accumulator_volume > 0.0:
        return solve_accumulator(end, source, oil_stored, step_time)
    if drawn <= source.max_flow:
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
    wave, velocity, wave_speed, bulk_modulus, area = end
    free = wave - source.mu
    drawn = -free * area * (1.0 + source.pressure / bulk_modulus)
    full = stored_oil(source.pressure, source)
    if oil_stored + step_time * (source.max_flow - drawn) >= full:
        return free, full
    low = riemann_variable(-0.999 * source.ambient, wave_speed, bulk_modulus)
    v_low, v_high = wave - source.mu, wave - low
    if oil_stored == 0.0:
        v_dry = solve_flow_end(end, -source.max_flow)
        p_dry = bulk_modulus * relative_compression((wave - v_dry) / wave_speed)
        if p_dry <= source.precharge:
            return v_dry, 0.0
    # residual = stored(p) - oil - dt (max_flow - drawn): falls with v, bracketed bisection-Newton
    for _ in range(60):
        p, q, z, slope = end_relation(wave, velocity, wave_speed, bulk_modulus, area)
        held = stored_oil(p, source)
        residual = held - oil_stored - step_time * (source.max_flow + q)
        if residual > 0.0:
            v_low = velocity
        else:
            v_high = velocity
        stiffness = (source.accumulator_volume - held) / (GAS_EXPONENT * (p + source.ambient))
        change = residual / (slope * (step_time + z * stiffness))
        trial = velocity + change
        if not v_low <= trial <= v_high:
            trial = 0.5 * (v_low + v_high)
        change = trial - velocity
        velocity = trial
        if abs(change) < VELOCITY_TOLERANCE * wave_speed:
            break
    p, q, z, slope = end_relation(wave, velocity, wave_speed, bulk_modulus, area)
    return velocity, max(0.0, oil_stored + step_time * (source.max_flow + q))
