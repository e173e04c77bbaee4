"""The cache of compiled kernels: where it lies, and what makes it a new one."""

import ast
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from runtime import warm
from runtime.kernels import cache


@pytest.fixture(autouse=True)
def nothing_remembered(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each test asks anew for the folder."""
    monkeypatch.setattr(cache, "cache_folder", cache.cache_folder.__wrapped__)
    monkeypatch.setattr(warm, "cache_folder", cache.cache_folder)
    monkeypatch.setattr(cache, "source_hash", cache.source_hash.__wrapped__)
    monkeypatch.setattr(cache.CONFIG, "CACHE_DIR", "")


def test_the_cache_lies_where_caches_lie(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))

    assert cache.cache_folder() == tmp_path / "cache" / "specc" / cache.source_hash()


def test_without_a_named_cache_it_lies_at_home(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setenv("HOME", str(tmp_path))

    assert cache.cache_folder() == tmp_path / ".cache" / "specc" / cache.source_hash()


def test_the_users_own_folder_comes_first(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(cache.CONFIG, "CACHE_DIR", str(tmp_path / "own"))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))

    assert cache.cache_folder() == tmp_path / "own" / "specc" / cache.source_hash()


def test_an_edited_kernel_has_a_new_cache(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    shutil.copytree(cache.SOURCES, tmp_path / "kernels")
    before = cache.source_hash()
    monkeypatch.setattr(cache, "SOURCES", tmp_path / "kernels")
    assert cache.source_hash() == before

    edited = tmp_path / "kernels" / "vectors.py"
    edited.write_text(edited.read_text() + "\n")

    assert cache.source_hash() != before


def test_where_nothing_can_be_written_kernels_still_run(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    in_the_way = tmp_path / "file"
    in_the_way.touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(in_the_way))
    monkeypatch.setenv("HOME", str(in_the_way))

    assert cache.cache_folder() is None
    assert not cache.is_warm()
    assert cache.kernel(twice)(2.0) == 4.0
    cache.mark_warm()
    assert not cache.is_warm()


def test_other_code_keeps_its_choice_of_cache(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))

    cache.kernel(twice)

    assert cache.CONFIG.CACHE_DIR == ""


def test_caches_of_other_sources_go_when_unused_for_long(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    folders = {name: tmp_path / "specc" / name for name in ("0" * 16, "1" * 16, "theirs")}
    for folder in folders.values():
        folder.mkdir(parents=True)
        (folder / "warm").touch()
        os.utime(folder / "warm", (0.0, 0.0))
    (folders["1" * 16] / "warm").touch()

    cache.mark_warm()

    assert cache.is_warm()
    assert [folder.exists() for folder in folders.values()] == [False, True, True]


def test_warming_tells_what_it_compiles(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    compiled: list[str] = []
    kernels = tuple((name, lambda name=name: compiled.append(name)) for name in ("a", "b"))
    monkeypatch.setattr(warm, "KERNELS", kernels)
    told: list[tuple[str, int, int]] = []

    warm.warm(lambda *progress: told.append(progress))

    assert compiled == ["a", "b"]
    assert told == [("a", 0, 2), ("b", 1, 2), ("", 2, 2)]


def test_what_one_clone_compiled_is_no_help_to_another(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(warm, "KERNELS", ())
    clone = Path(shutil.copytree(cache.SOURCES, tmp_path / "clone"))
    assert not warm.is_warm()

    warm.warm(lambda *_: None)
    assert warm.is_warm()
    monkeypatch.setattr(warm, "SOURCES", clone)
    assert not warm.is_warm()

    warm.warm(lambda *_: None)
    assert warm.is_warm()
    os.utime(clone / "vectors.py", (0.0, 0.0))
    assert not warm.is_warm()


def test_kernels_use_nothing_from_outside_their_folder() -> None:
    for path in cache.SOURCES.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom) and str(node.module).startswith("runtime"):
                # arrays: names of types only
                inside = str(node.module).startswith("runtime.kernels")
                assert inside or node.module == "runtime.arrays", (path.name, node.module)


def test_reading_a_program_needs_no_compiler() -> None:
    code = "import sys, runtime.program, runtime.code; sys.exit('numba' in sys.modules)"

    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def twice(x: float) -> float:
    return 2.0 * x
