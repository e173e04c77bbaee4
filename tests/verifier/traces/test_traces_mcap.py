"""MCAP files, whole and damaged: everything readable is read, every loss is said."""

import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mcap.writer import CompressionType

from spec_schema.diagnostics import SpecError
from verifier.traces.files.open_log import attached_program
from verifier.traces.trace import Trace

COUNT = 200
COMPRESSIONS = [CompressionType.NONE, CompressionType.LZ4, CompressionType.ZSTD]


@pytest.fixture(params=COMPRESSIONS, ids=lambda kind: kind.name.lower())
def log(request: pytest.FixtureRequest, workshop: Any, make: Any) -> Path:
    """Two hundred messages in chunks of about ten."""
    notes = [make.said("/a", 0.1 * i, x=float(i)) for i in range(COUNT)]
    path: Path = workshop.mcap(notes, compression=request.param, chunk_size=400)
    return path


def causes(trace: Trace) -> set[str]:
    return {loss.cause for loss in trace.losses}


def values(trace: Trace) -> list[float]:
    found: list[float] = trace.series["x"].values.tolist()
    return found


def chunks(data: bytes) -> list[tuple[int, int]]:
    """Begin and end of the bodies of all chunk records."""
    position, found = 8, []
    while position + 9 <= len(data):
        opcode, length = struct.unpack_from("<BQ", data, position)
        if opcode == 6:
            found.append((position + 9, position + 9 + length))
        position += 9 + length
    return found


def test_a_whole_file_is_read_without_a_loss(log: Path, workshop: Any) -> None:
    trace = workshop.read(log, x="/a.x")

    assert values(trace) == list(range(COUNT))
    assert trace.losses == ()
    # 0.1 s steps as nanoseconds, then as seconds: to rounding.
    np.testing.assert_allclose(trace.series["x"].times, 0.1 * np.arange(COUNT), atol=1e-9)


def test_a_file_without_chunks_or_index_is_read(workshop: Any, make: Any) -> None:
    notes = [make.said("/a", 0.1 * i, x=float(i)) for i in range(COUNT)]
    path = workshop.mcap(notes, use_chunking=False, use_statistics=False, use_summary_offsets=False)

    trace = workshop.read(path, x="/a.x")

    assert values(trace) == list(range(COUNT))
    assert trace.losses == ()


@pytest.mark.parametrize("share", [0.3, 0.5, 0.77])
def test_a_file_cut_in_mid_chunk_gives_what_is_before_the_cut(
    log: Path, workshop: Any, share: float
) -> None:
    data = log.read_bytes()
    cut = int(share * chunks(data)[-1][1])
    log.write_bytes(data[:cut])
    whole = sum(end <= cut for _, end in chunks(data))

    trace = workshop.read(log, x="/a.x")

    found = values(trace)
    assert found == list(range(len(found)))
    assert len(found) >= whole * COUNT // len(chunks(data)) - 10
    assert causes(trace) & {"file cut", "torn chunk", "file cut or overwritten"}


def test_of_a_single_torn_chunk_the_readable_part_is_read(workshop: Any, make: Any) -> None:
    rng = np.random.default_rng(1)
    # A zstd block holds up to 128 KiB: the file needs several.
    notes = [make.said("/a", 0.1 * i, x=float(i), r=rng.random()) for i in range(8000)]
    path = workshop.mcap(notes, compression=CompressionType.ZSTD, chunk_size=1 << 30)
    data = path.read_bytes()
    begin, end = chunks(data)[0]
    path.write_bytes(data[: begin + (end - begin) * 2 // 3])

    trace = workshop.read(path, x="/a.x")

    assert values(trace) == list(range(len(values(trace))))
    assert len(values(trace)) > 3000
    assert "torn chunk" in causes(trace)


def test_where_nothing_is_readable_the_damage_is_the_answer(workshop: Any, make: Any) -> None:
    notes = [make.said("/a", 0.1 * i, x=float(i)) for i in range(200)]
    path = workshop.mcap(notes, compression=CompressionType.ZSTD, chunk_size=1 << 30)
    data = path.read_bytes()
    begin, end = chunks(data)[0]
    path.write_bytes(data[: (begin + end) // 2])

    with pytest.raises(SpecError, match=r"(?s)V306.*no message of this log.*torn chunk"):
        workshop.read(path, x="/a.x")


def test_a_missing_last_byte_costs_nothing_and_is_said(log: Path, workshop: Any) -> None:
    log.write_bytes(log.read_bytes()[:-1])

    trace = workshop.read(log, x="/a.x")

    assert values(trace) == list(range(COUNT))
    assert causes(trace) == {"file end torn"}


def test_trailing_garbage_costs_nothing_and_is_said(log: Path, workshop: Any) -> None:
    log.write_bytes(log.read_bytes() + b"garbage")

    trace = workshop.read(log, x="/a.x")

    assert values(trace) == list(range(COUNT))
    assert [(loss.cause, loss.count) for loss in trace.losses] == [("trailing bytes", 7)]


def test_a_flipped_byte_in_a_chunk_drops_that_chunk_and_says_so(log: Path, workshop: Any) -> None:
    data = bytearray(log.read_bytes())
    _, end = chunks(bytes(data))[3]
    data[end - 30] ^= 0x10
    log.write_bytes(bytes(data))

    trace = workshop.read(log, x="/a.x")

    lost = sorted(set(range(COUNT)) - set(map(int, values(trace))))
    assert lost == list(range(lost[0], lost[-1] + 1))
    assert 0 < len(lost) < 20
    assert {loss.cause: loss.count for loss in trace.losses} == {
        "corrupt chunk": 1,
        "messages missing": len(lost),
    }


def test_a_file_without_checksums_is_noted(workshop: Any, make: Any) -> None:
    notes = [make.said("/a", 0.1 * i, x=float(i)) for i in range(20)]

    trace = workshop.read(workshop.mcap(notes, enable_crcs=False), x="/a.x")

    assert any("no checksum" in note for note in trace.notes)
    assert trace.losses == ()


def test_a_zeroed_chunk_is_said(log: Path, workshop: Any) -> None:
    data = bytearray(log.read_bytes())
    begin, end = chunks(bytes(data))[3]
    data[begin + 40 : end] = bytes(end - begin - 40)
    log.write_bytes(bytes(data))

    trace = workshop.read(log, x="/a.x")

    assert "corrupt chunk" in causes(trace)
    assert len(values(trace)) > COUNT - 20


def test_a_flipped_byte_outside_chunks_is_noticed(workshop: Any, make: Any) -> None:
    notes = [make.said("/a", 0.1 * i, x=1.5) for i in range(20)]
    path = workshop.mcap(notes, use_chunking=False, enable_data_crcs=True)
    path.write_bytes(path.read_bytes().replace(b"1.5", b"1.7", 1))

    trace = workshop.read(path, x="/a.x")

    assert "checksum wrong" in causes(trace)


def test_a_torn_json_row_is_counted(workshop: Any, make: Any) -> None:
    notes = [make.said("/a", 0.1 * i, x=float(i)) for i in range(20)]
    notes[7] = make.note("/a", 0.7, b'{"x": 7')

    trace = workshop.read(workshop.mcap(notes), x="/a.x")

    assert len(values(trace)) == 19
    assert [(loss.cause, loss.count) for loss in trace.losses] == [("unreadable messages", 1)]


def test_a_json_channel_without_a_schema_is_read(workshop: Any, make: Any) -> None:
    path = workshop.mcap(
        [make.said("/a", 0.1 * i, x=float(i)) for i in range(20)], chunk_size=1 << 20
    )
    whole = path.read_bytes()
    begin, end = chunks(whole)[0]
    body = bytearray(whole[begin:end])
    at = body.find(
        struct.pack("<BQ", 4, struct.unpack_from("<Q", body, body.find(b"\x04", 40) + 1)[0])
    )
    place = body.find(b"\x02\0\0\0/a") - 2
    assert at >= 0
    body[place : place + 2] = (77).to_bytes(2, "little")
    inside = bytes(body[40:])
    body[24:28] = zlib.crc32(inside).to_bytes(4, "little")
    cut = whole[:begin] + bytes(body)
    path.write_bytes(cut)

    trace = workshop.read(path, x="/a.x")

    assert values(trace) == list(range(20))
    assert any("names schema 77" in note for note in trace.notes)


def test_cdr_without_a_definition_says_so(workshop: Any, make: Any) -> None:
    path = workshop.mcap([make.note("/a", 0.0, b"\0\1\0\0" + bytes(8), "cdr")])

    with pytest.raises(SpecError, match="V311"):
        workshop.read(path, x="/a.x")


def test_the_attached_program_is_found_without_reading_messages(workshop: Any, make: Any) -> None:
    notes = [make.said("/a", 0.0, x=1.0)]
    path = workshop.mcap(notes, attachments={"readme.txt": b"no", "drive.specc": b"compiled"})

    assert attached_program(path) == ("drive.specc", b"compiled")


def test_an_attachment_that_was_altered_is_not_returned(workshop: Any, make: Any) -> None:
    path = workshop.mcap([make.said("/a", 0.0, x=1.0)], attachments={"drive.specc": b"compiled"})
    path.write_bytes(path.read_bytes().replace(b"compiled", b"compixed"))

    assert attached_program(path) is None


def test_other_files_carry_no_program(workshop: Any) -> None:
    assert attached_program(workshop.text("t,x\n0,1\n")) is None
    assert attached_program(workshop.folder) is None
    with pytest.raises(SpecError, match="V301"):
        attached_program(workshop.folder / "missing.mcap")


def test_several_channels_of_one_topic_are_read_together(workshop: Any, make: Any) -> None:
    text = '{"x": %d}'
    first = [make.said("/a", 0.2 * i, x=2.0 * i) for i in range(10)]
    other = [
        make.note("/a", 0.2 * i + 0.1, (text % (2 * i + 1)).encode(), schema="other")
        for i in range(10)
    ]

    notes = sorted([*first, *other], key=lambda note: note.time)
    trace = workshop.read(workshop.mcap(notes), x="/a.x")

    assert values(trace) == list(range(20))
    assert not any("out of order" in note for note in trace.notes)


def test_a_channel_in_another_encoding_is_refused_by_name(workshop: Any, make: Any) -> None:
    path = workshop.mcap([make.note("/a", 0.0, b"x", "flatbuffer", "A", "flatbuffer")])

    with pytest.raises(SpecError, match=r"(?s)V307.*'flatbuffer'.*json"):
        workshop.read(path, x="/a.x")


def test_a_folder_of_parts_is_one_log(workshop: Any, make: Any) -> None:
    workshop.mcap([make.said("/a", 0.1 * i, x=float(i)) for i in range(10)], "part_0.mcap")
    workshop.mcap([make.said("/a", 0.1 * i, x=float(i)) for i in range(10, 20)], "part_1.mcap")

    trace = workshop.read(workshop.folder, x="/a.x")

    assert values(trace) == list(range(20))
