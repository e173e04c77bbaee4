"""A learner saved, copied or pickled goes on bit for bit; what is no learner is refused."""

import copy
import io
import json
import pickle
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from lcs.alcsr.config import GROWN, Config, Readings
from lcs.alcsr.learner import ALCSR
from lcs.alcsr.readings import ErrorOf
from lcs.arrays import Array
from lcs.faults import LearnerError
from lcs.problems.classes import checkerboard
from lcs.saving import as_bytes, load, save
from lcs.state import State

CYCLES = 900


def problems() -> tuple[Array, Array]:
    x, rewards, _ = checkerboard(3).drawn(CYCLES, np.random.default_rng(1))
    return x, rewards


def assert_same(one: ALCSR, other: ALCSR) -> None:
    """The files would be the same, byte by byte."""
    assert as_bytes(one.state()) == as_bytes(other.state())


def through_a_file(learner: ALCSR, folder: Path) -> ALCSR:
    save(learner, folder / "learner")
    found = load(folder / "learner")
    assert isinstance(found, ALCSR)
    return found


COPIES: dict[str, Callable[[ALCSR, Path], ALCSR]] = {
    "saved": through_a_file,
    "copied": lambda learner, _: copy.deepcopy(learner),
    "pickled": lambda learner, _: pickle.loads(pickle.dumps(learner)),  # noqa: S301  our own
}


@pytest.mark.parametrize("config", [Config(), GROWN], ids=["thesis", "grown"])
@pytest.mark.parametrize("how", COPIES)
@pytest.mark.parametrize("stopped_at", ["act", "learn"])
def test_a_copy_goes_on_as_if_nothing_had_been_stopped(
    config: Config, how: str, stopped_at: str, tmp_path: Path
) -> None:
    x, rewards = problems()
    chance = np.random.default_rng(8)
    going, stopped = ALCSR(2, 2, config, seed=3), ALCSR(2, 2, config, seed=3)
    stops = np.sort(chance.choice(CYCLES, 6, replace=False))
    for t, (one, given) in enumerate(zip(x, rewards, strict=True)):
        if t in stops and stopped_at == "act":
            stopped = COPIES[how](stopped, tmp_path)
        action = going.act(one)
        assert stopped.act(one) == action
        if t in stops and stopped_at == "learn":
            stopped = COPIES[how](stopped, tmp_path)
            assert stopped.is_trying == going.is_trying
        going.learn(given[action])
        stopped.learn(given[action])

    assert_same(going, stopped)


def test_a_copy_and_its_original_share_nothing(tmp_path: Path) -> None:
    x, rewards = problems()
    learner = ALCSR(2, 2, seed=3)
    learner.run(x[:300], rewards[:300])
    before = as_bytes(learner.state())

    for make in COPIES.values():
        make(learner, tmp_path).run(x[300:], rewards[300:])

    assert as_bytes(learner.state()) == before


def test_room_that_has_grown_and_every_constant_are_kept(tmp_path: Path) -> None:
    config = Config(explore=0.75, corpses=7, readings=Readings(error_of=ErrorOf.RANGE))
    learner = ALCSR(3, 2, config, reward_range=500.0, seed=1)
    learner.population.make_room()
    rules = learner.population.rules
    rules.living[:] = rules.prediction.shape[1] - 1
    learner.population.make_room()

    found = through_a_file(learner, tmp_path)

    assert found.config == config
    assert found.population.rules.prediction.shape == learner.population.rules.prediction.shape
    assert found.population.numbers == learner.population.numbers
    assert_same(learner, found)


def test_a_file_is_whole_or_as_it_was_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    save(ALCSR(2, 2, seed=3), tmp_path / "learner")
    before = (tmp_path / "learner").read_bytes()

    def fails(_: int) -> None:
        raise OSError("the disk is full")

    monkeypatch.setattr("os.fsync", fails)
    with pytest.raises(OSError, match="disk is full"):
        save(ALCSR(2, 2, seed=4), tmp_path / "learner")

    assert (tmp_path / "learner").read_bytes() == before
    assert [each.name for each in tmp_path.iterdir()] == ["learner"]


def test_a_folder_is_no_file_to_save_to_or_load_from(tmp_path: Path) -> None:
    learner = ALCSR(2, 2, seed=3)
    with pytest.raises(
        LearnerError, match=r"is a folder: name a file in it, such as .*learner.npz"
    ):
        save(learner, tmp_path)
    with pytest.raises(LearnerError, match="is a folder: name a file in it"):
        load(tmp_path)
    with pytest.raises(LearnerError, match="none is no folder: make it first"):
        save(learner, tmp_path / "none" / "learner.npz")

    assert list(tmp_path.iterdir()) == []


def test_numpy_reads_the_arrays_of_the_file(tmp_path: Path) -> None:
    learner = ALCSR(2, 2, seed=3)
    learner.run(*problems())
    save(learner, tmp_path / "learner.npz")

    with np.load(tmp_path / "learner.npz", allow_pickle=False) as found:
        assert np.array_equal(found["rules.lower"], learner.population.rules.lower)


def test_a_file_cut_off_or_changed_anywhere_is_refused(tmp_path: Path) -> None:
    learner = ALCSR(2, 2, seed=3)
    learner.run(*problems())
    content = as_bytes(learner.state())
    path = tmp_path / "learner"
    for length in np.linspace(0, len(content) - 1, 25).astype(int):
        path.write_bytes(content[:length])
        with pytest.raises(LearnerError, match="learner holds no learner"):
            load(path)

    for at in np.linspace(0, len(content) - 1, 60).astype(int):
        path.write_bytes(content[:at] + bytes([content[at] ^ 0x10]) + content[at + 1 :])
        try:
            found = load(path)
        except LearnerError:
            continue
        assert_same(learner, found)  # a bit that means nothing, such as a date


def edited(content: bytes, edit: Callable[[dict[str, object]], object]) -> bytes:
    """The file with another header."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        entries = {name: archive.read(name) for name in archive.namelist()}
    header = json.loads(entries["header.json"])
    edit(header)
    entries["header.json"] = json.dumps(header).encode()
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as archive:
        for name, values in entries.items():
            archive.writestr(name, values)
    return made.getvalue()


EDITS: dict[str, Callable[[dict], object]] = {  # type: ignore[type-arg]  # as JSON has it
    "its version is 99": lambda header: header.update(version=99),
    "does not say": lambda header: header.update(format="a cake"),
    "its kind is 'ELF': known are ALCSR": lambda header: header.update(kind="ELF"),
    "does not name kind": lambda header: header.pop("kind"),
    "'values.config.explore' is missing": lambda h: h["values"]["config"].pop("explore"),
    "'values.config.zeal' is unknown": lambda h: h["values"]["config"].update(zeal=1),
    "'values.config.explore' is 'x'": lambda h: h["values"]["config"].update(explore="x"),
    "error_of' is 'MOOD': known are REWARD, RANGE": lambda h: h["values"]["config"][
        "readings"
    ].update(error_of="MOOD"),
    "chance can't be read": lambda h: h["values"]["chance"].update(bit_generator="Dice"),
    "'rules.lower' is missing": lambda h: h["arrays"].remove("rules.lower"),
    "does not fit": lambda h: h["values"].update(inputs=3),
}


@pytest.mark.parametrize("said", EDITS)
def test_what_another_version_or_program_wrote_is_refused_by_its_name(
    said: str, tmp_path: Path
) -> None:
    (tmp_path / "learner").write_bytes(edited(as_bytes(ALCSR(2, 2).state()), EDITS[said]))

    with pytest.raises(LearnerError, match=said):
        load(tmp_path / "learner")


def test_a_pickle_in_the_file_is_not_opened(tmp_path: Path) -> None:
    state = ALCSR(2, 2).state()
    content = io.BytesIO()
    np.lib.format.write_array(content, np.array([{}], object), allow_pickle=True)
    with zipfile.ZipFile(io.BytesIO(as_bytes(state))) as archive:
        entries = {name: archive.read(name) for name in archive.namelist()}
    with zipfile.ZipFile(tmp_path / "learner", "w") as archive:
        for name, values in {**entries, "rules.lower.npy": content.getvalue()}.items():
            archive.writestr(name, values)

    with pytest.raises(LearnerError, match=r"'rules\.lower' is no array of numbers"):
        load(tmp_path / "learner")


def test_more_rules_than_room_are_refused() -> None:
    state = ALCSR(2, 2).state()
    state.arrays["rules.living"][0] = 5_000
    with pytest.raises(LearnerError, match="room"):
        ALCSR.from_state(State(state.kind, state.plain, state.arrays))


def test_chance_of_another_kind_is_refused() -> None:
    learner = ALCSR(2, 2)
    learner.chance = np.random.Generator(np.random.MT19937(1))
    with pytest.raises(LearnerError, match="PCG64"):
        learner.state()


def test_a_file_that_is_not_there_is_no_learner_but_missing(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        load(tmp_path / "nothing")
