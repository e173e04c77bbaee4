"""The principles of section 2.4: how each is kept, what fails without it, and a figure."""

from collections.abc import Callable
from typing import NamedTuple

from tests.principles import (
    test_1a_scale,
    test_1b_continuity,
    test_1c_occupancy,
    test_1d_embodiment,
    test_1e_situation,
    test_1f_laws,
    test_1g_watching,
    test_1h_grounding,
    test_2a_own_pace,
    test_2b_resolution,
    test_2c_relations,
    test_2d_parallel,
    test_2e_opportunity,
    test_2f_response,
    test_2g_orders,
)

MILLI, NANO = 1e3, 1e9


class Principle(NamedTuple):
    """letter: of section 2.4. broken: what was done to the code to see tests fail. fails: those.

    kept: how, with files. figure: measures it anew.
    """

    letter: str
    said: str
    kept: str
    broken: str
    fails: tuple[str, ...]
    figure: Callable[[], str]


def _ratio(errors: tuple[float, ...]) -> str:
    return f"{errors[0] / errors[1]:.2f} times"


PRINCIPLES = (
    Principle(
        "1a",
        "Lengths, masses and light are to scale with the real world.",
        "Units are read once and everything is SI from there on (`spec_schema/units.py`, "
        "`compiler/world/`); ways, sensors and shapes share one metre (`runtime/world/`).",
        "a circle made a tenth too large (`compiler/world/shapes.py`)",
        ("test_a_gap_lets_a_robot_through_that_is_a_millimetre_narrower_and_no_other",),
        lambda: (
            f"2 m driven are {abs(test_1a_scale.error_of_way()) * 1e6:.0f} µm off; "
            "a gap 1 mm wider lets a robot pass, one 1 mm narrower does not"
        ),
    ),
    Principle(
        "1b",
        "Space is continuous, or as fine as one likes.",
        "Places are numbers, not cells; rays and light are computed from shapes, never from a map "
        "(`runtime/world/kernels/`); steps are cut so that nothing moves over 2 mm past another "
        "(`runtime/world/world.py`).",
        "ranges rounded to 1 mm; steps not cut for what is fast (`runtime/world/world.py`)",
        (
            "test_a_move_of_a_nanometre_is_a_nanometre_to_a_range_sensor",
            "test_nothing_drives_through_a_wall_however_thin_it_is",
        ),
        lambda: (
            f"a move of {test_1b_continuity.smallest_told() * NANO:.0f} nm is sensed; a curve of "
            f"2.4 m ends {test_1b_continuity.errors_of_curve()[0] * MILLI:.1f} mm off with steps "
            f"of 5 ms, and {_ratio(test_1b_continuity.errors_of_curve())} nearer with half of that"
        ),
    ),
    Principle(
        "1c",
        "No point is occupied by two things.",
        "Rigid contacts, a fifth of a depth taken back in 1/240 s, and an audit of the deepest one "
        "of every step (`runtime/world/space.py`, `audit.py`). Not exact: what is pressed stands "
        "up to 2 mm deep.",
        "things that move let through one another (`runtime/world/space.py`)",
        ("test_in_a_crowd_that_is_ploughed_nothing_stands_in_anything_else",),
        lambda: (
            f"{test_1c_occupancy.crowd()[1] * MILLI:.1f} mm at the deepest, in 6 s of three "
            "robots in a crowd of 24 (limit 2 mm)"
        ),
    ),
    Principle(
        "1d",
        "Agents are embodied: they act on the world, it acts on them, and they feel both.",
        "Drives are motors with limited force on a body with a mass (`runtime/world/drive.py`); "
        "sensors sample the world as it became (`runtime/world/sensing.py`).",
        "drives with any force that it takes; a bumper that feels nothing",
        (
            "test_what_is_too_heavy_holds_the_robot_back_and_what_is_light_goes_along",
            "test_what_it_runs_into_is_felt_at_the_next_sample",
        ),
        lambda: (
            f"a contact is felt {test_1d_embodiment.felt_after() * MILLI:.0f} ms after it begins, "
            "at samples every 10 ms"
        ),
    ),
    Principle(
        "1e",
        "Agents are situated: the here and now decides, and is answered in time.",
        "A sensor samples where all are at that instant (`runtime/world/world.py: geometry`); "
        "nothing keeps a model of the world in its place.",
        "senses that look at where all stood up to 20 steps ago",
        (
            "test_what_is_sensed_is_what_there_is_now",
            "test_what_comes_in_its_way_is_answered_within_one_sample_one_period_and_its_response",
        ),
        lambda: (
            f"readings are {test_1e_situation.staleness() * NANO:.0f} nm off what there is, among "
            f"things that move; who crosses is answered "
            f"{test_1e_situation.answered_after() * MILLI:.0f} "
            "ms later, with a response time of 100 ms"
        ),
    ),
    Principle(
        "1f",
        "The same physical laws hold for every agent, whatever the processing load.",
        "One space for all bodies, steps of one length, and nothing of a drive depends on who is "
        "first or how much it computes (`runtime/world/drive.py`, `runtime/scheduler/`).",
        "twice the grip for who is named first; less speed for one with more nodes",
        (
            "test_neither_of_two_equal_robots_that_push_one_another_wins",
            "test_a_robot_with_thirty_more_behaviors_to_run_is_no_slower_and_no_faster",
        ),
        lambda: (
            f"four robots in equal cells differ by {test_1f_laws.differences() * NANO:.0f} nm; of "
            f"two that push one another neither gains "
            f"{test_1f_laws.advantage() * NANO:.0f} nm"
        ),
    ),
    Principle(
        "1g",
        "Behaviors can be watched as in the real world.",
        "Recordings hold shapes and poses at least 50 times a second, for Foxglove and rerun "
        "(`runtime/recording/drawn.py`); posters and films (`specc/figures/`).",
        "poses looked at four times a second (`runtime/run.py`)",
        (
            "test_who_watches_the_recording_alone_sees_what_the_robot_does",
            "test_nothing_happens_between_two_pictures",
        ),
        lambda: (
            f"from picture to picture a robot moves by at most "
            f"{test_1g_watching.between_pictures():.1f} % of its length; speed and turn, measured "
            f"on the pictures alone, are {test_1g_watching.misseen()[0] * MILLI:.1f} mm/s and "
            f"{test_1g_watching.misseen()[1] * MILLI:.1f} mrad/s off"
        ),
    ),
    Principle(
        "1h",
        "Agents are grounded: all that a behavior works on was sensed, or comes from what was.",
        "A node reads a board of numbers that sensors and nodes wrote; no wire leads from anything "
        "else (`runtime/scheduler/inputs.py`, `compiler/architecture/wires.py`).",
        "a node that holds on to the world; noise left out on the way to the board",
        (
            "test_from_a_node_no_part_of_the_world_can_be_reached",
            "test_what_a_behavior_gets_is_what_its_sensor_said_noise_and_all",
        ),
        lambda: (
            "0 objects of the world can be reached from a node; "
            f"{test_1h_grounding.differing()} numbers of its ticks differ where a thing that no "
            "sensor can tell stands elsewhere"
        ),
    ),
    Principle(
        "2a",
        "Simulated time proceeds independently of any behavior.",
        "The scheduler takes one step after another, whoever is due "
        "(`runtime/scheduler/scheduler.py: step`).",
        "a world that goes on only where a node ticks soon",
        ("test_the_clock_runs_where_nothing_is_due",),
        lambda: (
            f"the ticks of 22 behaviors at 20 rates are {test_2a_own_pace.late_ticks() * NANO:.0f} "
            "ns off their multiples, and none is missed"
        ),
    ),
    Principle(
        "2b",
        "Time is continuous, or as fine as one likes.",
        "The step divides every time that a scenario speaks of, or the scenario is refused "
        "(`compiler/architecture/times.py`); physics takes no step over 5 ms "
        "(`runtime/world/world.py`).",
        "response times rounded to 10 ms; physics with steps of any length",
        (
            "test_a_millisecond_more_of_response_time_is_a_millisecond_more_of_way",
            "test_whatever_its_scenario_says_physics_takes_no_step_over_5_ms",
        ),
        lambda: (
            f"response times of 100 and 101 ms differ by {test_2b_resolution.told_apart():.3f} ms "
            "in where a robot stops; with half the step a turn ends "
            f"{_ratio(test_2b_resolution.errors_of_turn())} nearer"
        ),
    ),
    Principle(
        "2c",
        "Relations in simulated time do not depend on the real time of processing.",
        "Time is counted in steps; no clock of a computer is read (`runtime/scheduler/clock.py`).",
        "real time spent on a tick added to its response time",
        (
            "test_no_interval_changes_where_processing_takes_random_times",
            "test_from_sample_to_channel_it_takes_what_latency_and_response_time_say",
        ),
        lambda: (
            "30 ms of latency and 70 ms of response are "
            f"{test_2c_relations.chain() * MILLI:.3f} ms "
            "on a computer that is held up at random"
        ),
    ),
    Principle(
        "2d",
        "Any number of behaviors may be active at once without distorting space or time.",
        "All that are due at an instant sample the same board before anybody speaks "
        "(`runtime/scheduler/scheduler.py`).",
        "at most 20 nodes ticked at an instant",
        (
            "test_a_hundred_behaviors_more_change_no_place_and_no_time",
            "test_all_of_them_are_active_at_each_of_their_instants",
        ),
        lambda: (
            f"{test_2d_parallel.missed()} ticks missed by 101 behaviors; "
            f"{test_2d_parallel.shifted()} numbers of the way differ from that with one"
        ),
    ),
    Principle(
        "2e",
        "How often a behavior can act follows from its response time, not from what its "
        "environment costs to compute.",
        "Nodes are due at multiples of their own periods and act their own response time later "
        "(`runtime/scheduler/clock.py`).",
        "a node passed over where the world took over 0.1 ms",
        (
            "test_an_environment_that_costs_more_gives_a_behavior_no_fewer_opportunities",
            "test_a_behavior_twice_as_quick_has_twice_the_opportunities",
        ),
        lambda: (
            "acts in 2 s, at periods and response times of 10, 20, 50, 100 ms: "
            + ", ".join(str(count) for count in test_2e_opportunity.opportunities().values())
        ),
    ),
    Principle(
        "2f",
        "A response time may differ from the time that processing takes.",
        "`response_time` of a node is a number of its spec: what it says waits for it in a queue "
        "(`runtime/scheduler/scheduler.py`).",
        "responses that take one step, as computing them nearly does",
        ("test_a_robot_overruns_by_its_speed_times_its_response_time",),
        lambda: (
            f"a robot at 1 m/s overruns by {test_2f_response.seconds_per_second():.6f} m for each "
            "second of response time, from 0 to 400 ms, with the same code"
        ),
    ),
    Principle(
        "2g",
        "Times to move a share of its length and response times are in the proportion that they "
        "have in reality.",
        "Speeds, lengths and response times are in real units, none scaled; what answers too late "
        "for its field is refused (`compiler/architecture/timing.py`).",
        "a world that goes on twice as fast as its behaviors (`runtime/scheduler/scheduler.py`)",
        ("test_before_it_answers_a_robot_moves_by_as_many_lengths_as_its_speed_and_response_say",),
        lambda: (
            f"{test_2g_orders.moved_before(0.3):.6f} lengths before it answers, of 24 cm, at "
            "0.4 m/s and 0.3 s (closed form: 0.5)"
        ),
    ),
)
