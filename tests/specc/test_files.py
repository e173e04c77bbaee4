"""Files are written whole or not at all, also by several at once."""

import os
import stat
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from spec_schema.diagnostics import SpecError
from specc.files import write_atomically


def test_a_file_that_several_write_at_once_is_that_of_one_of_them(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    wanted = [bytes([k]) * 3_000_000 for k in range(8)]

    with ThreadPoolExecutor(8) as pool:
        list(pool.map(lambda data: write_atomically(path, data), wanted))

    assert path.read_bytes() in wanted
    assert list(tmp_path.iterdir()) == [path]


def test_whoever_may_read_other_new_files_may_read_this_one(tmp_path: Path) -> None:
    ordinary, ours = tmp_path / "ordinary", tmp_path / "ours"
    before = os.umask(0o027)
    try:
        ordinary.write_bytes(b"x")
        write_atomically(ours, b"x")
    finally:
        os.umask(before)

    assert stat.S_IMODE(ours.stat().st_mode) == stat.S_IMODE(ordinary.stat().st_mode) == 0o640


def test_what_can_not_be_written_leaves_nothing_behind(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"x")

    with pytest.raises(SpecError):
        write_atomically(tmp_path / "file" / "below", b"x")

    assert [each.name for each in tmp_path.iterdir()] == ["file"]
