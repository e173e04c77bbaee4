"""Changes of mode: how late the robot made each of them, over the trace."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from specc.figures.style import BLUE, FAINT, GREEN, INK, VERMILION, bare, framed, look
from verifier.report.switching import Switch, Switching, SwitchSort

LOOKS = (("o", BLUE), ("s", VERMILION), ("^", INK), ("D", GREEN), ("v", FAINT))
LONE = {SwitchSort.UNEXPECTED, SwitchSort.MISSED, SwitchSort.WRONG_TARGET, SwitchSort.UNDECLARED}


def draw_switches(switching: Switching) -> Figure:
    """Lateness over time, a look per way; the allowed lateness as a bar behind each switch."""
    with look():
        figure = Figure(figsize=(7.2, 2.9))
        axes = figure.add_subplot(framed(figure, 1, 1, (0.9, 0.15, 0.5, 0.4))[0])
        bare(axes)
        axes.axhline(0.0, color=FAINT, linewidth=0.7)
        handles = []
        for k, way in enumerate(switching.ways):
            marker, color = LOOKS[k % len(LOOKS)]
            known = [s for s in switching.switches if _is_timed(s, way.source, way.target)]
            if known:
                _timed(axes, known, marker, color)
                handles.append(_handle(marker, color, f"{way.source} to {way.target}"))
        lone = [s.time for s in switching.switches if s.sort in LONE]
        if lone:
            _at_the_bottom(axes, lone)
            handles.append(_handle("x", VERMILION, "no partner"))
        axes.set_xlabel("time [s]")
        axes.set_ylabel("later than the spec [s]")
        figure.legend(handles=handles, loc="upper left", ncols=4, borderaxespad=0.2)
    return figure


def _handle(marker: str, color: str, label: str) -> Line2D:
    return Line2D([], [], linestyle="none", marker=marker, color=color, label=label)


def _at_the_bottom(axes: Axes, times: list[float]) -> None:
    transform = axes.get_xaxis_transform()
    axes.plot(times, [0.03] * len(times), "x", color=VERMILION, transform=transform, clip_on=False)


def _is_timed(switch: Switch, source: str, target: str) -> bool:
    is_way = (switch.source, switch.target) == (source, target)
    return is_way and switch.sort is SwitchSort.EXPECTED and np.isfinite(switch.late)


def _timed(axes: Axes, switches: list[Switch], marker: str, color: str) -> None:
    times = np.array([switch.time for switch in switches])
    allowed = np.array([switch.allowed for switch in switches])
    doubt = np.array([switch.doubt for switch in switches])
    late = np.array([switch.late for switch in switches])
    known = np.isfinite(allowed)
    axes.vlines(
        times[known], -allowed[known], allowed[known], color=GREEN, alpha=0.25, linewidth=5.0
    )
    axes.errorbar(
        times,
        late,
        yerr=np.nan_to_num(doubt),
        fmt=marker,
        color=color,
        markersize=4.0,
        linewidth=0.8,
    )
