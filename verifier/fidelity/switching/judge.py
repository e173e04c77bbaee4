"""The judgement of mode changes: by their times and by their jumps, way by way."""

from collections import Counter

from runtime.program import Fidelity, Program
from verifier.fidelity.stretches.needs import Needs, mode_of
from verifier.fidelity.switching import sentences
from verifier.fidelity.switching.arrivals import arrivals_of
from verifier.fidelity.switching.jumps import jumps_of
from verifier.fidelity.switching.means import Mean, standings_of
from verifier.fidelity.switching.setting import Setting, setting_of
from verifier.fidelity.switching.sorting import missed_switches, sorted_switches
from verifier.fidelity.switching.stays import Stay, stays_of
from verifier.fidelity.switching.told import needs_told
from verifier.fidelity.switching.ways import Compared, WayMeans, means_of
from verifier.report.report import Interval, Standing
from verifier.report.switching import Jump, Switch, Switching, SwitchSort, Timing, Way

FEWEST = 3
"""With fewer samples there is nothing to fit."""
ROUNDING = 1e-9
"""Of what is allowed: so little is no difference."""
AGAINST = {SwitchSort.UNEXPECTED, SwitchSort.MISSED, SwitchSort.WRONG_TARGET}


def switching_of(
    program: Program, needs: Needs, fidelity: Fidelity
) -> tuple[Switching, Needs] | None:
    """The judgement of all changes of mode; None without ways out of modes, or without samples.

    Also the needs, with the changes at the times that the states tell. `needs` holds every
    predicted state, perhaps without the mode: then the sentences say that nothing can be said.
    """
    if not program.field.guards or len(needs.series[needs.base].times) < FEWEST:
        return None
    mode = mode_of(program, needs)
    if mode is not None and not mode.is_known:
        reason, advice = sentences.not_logged(program)
        untold = Switching(program.field.mode, (), (), Standing.UNDECIDED, (reason,), (advice,))
        return untold, needs
    setting = setting_of(program, needs, fidelity)
    judgement, compared = judged_changes(setting)
    return judgement, needs if compared is None else needs_told(
        program, needs, setting, compared.jumps
    )


def judged_changes(setting: Setting) -> tuple[Switching, Compared | None]:
    """The judgement, and what it rests on; None where the mode never changes."""
    stays = stays_of(setting)
    missed = tuple(missed_switches(setting, stays))
    if len(setting.changes) == 0:
        return _switching(setting, _ways(setting, (), missed), missed), None
    compared = _compared(setting, stays)
    every = tuple(sorted((*compared.switches, *missed), key=lambda each: each.time))
    return _switching(setting, _ways(setting, means_of(compared), every), every), compared


def _compared(setting: Setting, stays: tuple[Stay, ...]) -> Compared:
    """All changes beside the model."""
    arrivals = arrivals_of(setting, stays)
    jumps = jumps_of(setting, stays, arrivals.guards)
    return Compared(setting, arrivals, jumps, sorted_switches(setting, stays, arrivals, jumps))


def _ways(
    setting: Setting, means: tuple[WayMeans, ...], switches: tuple[Switch, ...]
) -> tuple[Way, ...]:
    """The guards with their means, all judged together; without means, none was taken."""
    judged = [way.late for way in means if way.late is not None]
    judged += [mean for way in means for _, mean in way.jumps]
    standings = dict(zip(judged, standings_of(judged), strict=True))
    by_guard = {way.guard: way for way in means}
    return tuple(
        _way(setting, by_guard.get(index, _nothing(index)), switches, standings)
        for index in range(len(setting.guards))
    )


def _nothing(guard: int) -> WayMeans:
    return WayMeans(guard, None, "", 0.0, ())


def _way(
    setting: Setting,
    means: WayMeans,
    switches: tuple[Switch, ...],
    standings: dict[Mean, Standing],
) -> Way:
    guard, names = setting.guards[means.guard], setting.mode_names
    source, target = names[guard.mode], names[guard.target]
    sorts = Counter(
        each.sort
        for each in switches
        if each.source == source and target == (each.wanted or each.target)
    )
    timing = _timing(means, standings)
    jumps = tuple(_jump(setting, means.guard, j, mean, standings) for j, mean in means.jumps)
    every = [*([timing.standing] if timing else []), *(jump.standing for jump in jumps)]
    return Way(
        source=source,
        target=target,
        expected=sorts[SwitchSort.EXPECTED],
        unexpected=sorts[SwitchSort.UNEXPECTED],
        missed=sorts[SwitchSort.MISSED],
        wrong=sorts[SwitchSort.WRONG_TARGET],
        timing=timing,
        jumps=jumps,
        standing=Standing.EXCEEDED if any(sorts[s] for s in AGAINST) else worst_of(every),
        origin=guard.origin,
    )


def _timing(means: WayMeans, standings: dict[Mean, Standing]) -> Timing | None:
    late = means.late
    if late is None:
        return None
    return Timing(
        count=late.count,
        late=_told(late.mean, late.allowed),
        interval=_interval(late),
        allowed=late.allowed,
        basis=means.basis,
        resolution=means.resolution,
        standing=standings[late],
        sample=late.sample,
    )


def _jump(
    setting: Setting, guard: int, j: int, mean: Mean, standings: dict[Mean, Standing]
) -> Jump:
    state = setting.samples[j].state
    return Jump(
        name=state.name,
        unit=state.unit,
        is_reset=any(name == state.name for name, _ in setting.guards[guard].resets),
        count=mean.count,
        error=_told(mean.mean, mean.allowed),
        interval=_interval(mean),
        tolerance=mean.allowed,
        standing=standings[mean],
        sample=mean.sample,
    )


def _interval(mean: Mean) -> Interval:
    return Interval(_told(mean.interval.low, mean.allowed), _told(mean.interval.high, mean.allowed))


def _told(value: float, allowed: float) -> float:
    """The value; 0 where it is but the rounding of what was subtracted."""
    return value if abs(value) > ROUNDING * allowed else 0.0


def worst_of(standings: list[Standing]) -> Standing:
    """EXCEEDED before UNDECIDED before WITHIN; of nothing, UNDECIDED."""
    for standing in (Standing.EXCEEDED, Standing.UNDECIDED):
        if standing in standings:
            return standing
    return Standing.WITHIN if standings else Standing.UNDECIDED


def _switching(setting: Setting, ways: tuple[Way, ...], switches: tuple[Switch, ...]) -> Switching:
    taken = [way for way in ways if way.expected or way.standing is Standing.EXCEEDED]
    standings = [way.standing for way in taken]
    if any(each.sort is SwitchSort.UNDECLARED for each in switches):
        standings.append(Standing.EXCEEDED)
    reasons = sentences.reasons(setting.program.field.mode, ways, switches)
    return Switching(
        mode=setting.program.field.mode,
        ways=ways,
        switches=switches,
        standing=worst_of(standings),
        reasons=reasons,
        advice=sentences.advice(ways, switches),
    )
