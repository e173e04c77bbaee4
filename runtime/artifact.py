"""The artifact `NAME.specc`: a compiled behavior in one file that loads without the compiler.

`program.json` and one `.npy` array per table, in a container of which every byte is determined and
checked (`runtime.container`). The same program gives the same bytes on every machine.
"""

import mmap
import os
import tempfile
from pathlib import Path
from typing import Final

import numpy as np

from runtime.arrays import Array
from runtime.consistency import faults
from runtime.container import ArtifactError, Member, join, split
from runtime.program import Program
from runtime.program_json import from_json, to_json

__all__ = ["ArtifactError", "from_bytes", "read", "to_bytes", "write"]

PROGRAM: Final = "program.json"
MAGIC: Final = b"\x93NUMPY\x01\x00"
"""The .npy format, version 1.0 (numpy.lib.format)."""
HEADER_ALIGNMENT: Final = 64


def to_bytes(program: Program) -> bytes:
    """The artifact of a program.

    Raises:
        ArtifactError: the program does not fit together, or is too large.
    """
    for fault in faults(program):
        raise ArtifactError(f"the program '{program.name}' does not fit together: {fault}")
    arrays = [table.coefficients for table in program.field.tables]
    names = [_table_name(index) for index in range(len(arrays))]
    members = [Member(PROGRAM, memoryview(to_json(program, names)))]
    pairs = zip(names, arrays, strict=True)
    members += [Member(name, memoryview(_npy(array))) for name, array in pairs]
    return join(members)


def from_bytes(data: bytes) -> Program:
    """The program of an artifact.

    Raises:
        ArtifactError: the data was cut or altered, or is no artifact of this version.
    """
    return _program(memoryview(data))


def write(program: Program, path: Path) -> None:
    """Write the artifact; at no time is there a half-written file under `path`."""
    replace_file(path, to_bytes(program))


def read(path: Path) -> Program:
    """The program of an artifact file; its tables stay in the file, mapped into memory.

    Raises:
        ArtifactError: the file was cut or altered, or is no artifact of this version.
        OSError: the file cannot be read.
    """
    if path.stat().st_size == 0:
        raise ArtifactError("the file is empty")
    with path.open("rb") as file:
        return _program(memoryview(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)))


def replace_file(path: Path, data: bytes) -> None:
    """Put `data` under `path` in one step."""
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        Path(temporary).chmod(0o644)
        Path(temporary).replace(path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


def _program(data: memoryview) -> Program:
    members = split(data)
    contents = dict(members)
    names = [_table_name(index) for index in range(len(members) - 1)]
    if [name for name, _ in members] != [PROGRAM, *names]:
        raise ArtifactError("the artifact has other parts than a program and its tables")
    used: list[str] = []

    def load(name: str, shape: tuple[int, ...]) -> Array:
        used.append(name)
        return _array(name, contents.get(name), shape)

    program = from_json(bytes(contents[PROGRAM]), load)
    for fault in faults(program):
        raise ArtifactError(f"the artifact does not fit together: {fault}")
    # One program, one artifact: nothing may stand in it that this program would not write.
    if used != names or to_json(program, names) != contents[PROGRAM]:
        raise ArtifactError("the artifact was not written by specc")
    return program


def _table_name(index: int) -> str:
    return f"tables/{index}.npy"


def _npy(array: Array) -> bytes:
    return _npy_header(array.shape) + np.ascontiguousarray(array, dtype="<f8").tobytes()


def _npy_header(shape: tuple[int, ...]) -> bytes:
    """The header that `numpy.save` writes, padded so that the numbers begin aligned."""
    text = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}"
    padding = -(len(MAGIC) + 2 + len(text) + 1) % HEADER_ALIGNMENT
    header = f"{text}{' ' * padding}\n".encode("ascii")
    return MAGIC + len(header).to_bytes(2, "little") + header


def _array(name: str, content: memoryview | None, shape: tuple[int, ...]) -> Array:
    """The numbers of a member, where they are; read-only."""
    if content is None:
        raise ArtifactError(f"the artifact lacks its part '{name}'")
    header = _npy_header(shape)
    count = 1
    for size in shape:
        count *= max(size, 0)
    if bytes(content[: len(header)]) != header or len(content) != len(header) + 8 * count:
        raise ArtifactError(f"'{name}' does not hold a table of the shape {shape}")
    numbers: Array = np.frombuffer(content, dtype="<f8", offset=len(header)).reshape(shape)
    numbers.setflags(write=False)
    return numbers
