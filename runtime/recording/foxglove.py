"""The Foxglove schemas that runs are drawn with, as protobuf.

The names, numbers and types of fields are those of
https://github.com/foxglove/foxglove-sdk/tree/main/schemas/proto (MIT). Why they
stand here: ADR 25.
"""

from functools import cache
from typing import Any, Final

from google.protobuf import (
    descriptor_pb2,
    descriptor_pool,
    duration_pb2,
    message_factory,
    timestamp_pb2,
)

PACKAGE: Final = "foxglove"
TIME: Final = ".google.protobuf.Timestamp"
SPAN: Final = ".google.protobuf.Duration"
SCHEMAS: Final = """
Vector2: x double 1, y double 2
Vector3: x double 1, y double 2, z double 3
Point3: x double 1, y double 2, z double 3
Quaternion: x double 1, y double 2, z double 3, w double 4
Pose: position Vector3 1, orientation Quaternion 2
Color: r double 1, g double 2, b double 3, a double 4
KeyValuePair: key string 1, value string 2
PackedElementField: name string 1, offset fixed32 2, type NumericType 3
NumericType = UNKNOWN 0, UINT8 1, INT8 2, UINT16 3, INT16 4, UINT32 5, INT32 6, FLOAT32 7, FLOAT64 8
FrameTransform: timestamp time 1, parent_frame_id string 2, child_frame_id string 3, \
translation Vector3 4, rotation Quaternion 5
FrameTransforms: transforms FrameTransform* 1
PosesInFrame: timestamp time 1, frame_id string 2, poses Pose* 3
LaserScan: timestamp time 1, frame_id string 2, pose Pose 3, start_angle double 4, \
end_angle double 5, ranges double* 6, intensities double* 7
PointCloud: timestamp time 1, frame_id string 2, pose Pose 3, point_stride fixed32 4, \
fields PackedElementField* 5, data bytes 6
Grid: timestamp time 1, frame_id string 2, pose Pose 3, column_count fixed32 4, \
cell_size Vector2 5, row_stride fixed32 6, cell_stride fixed32 7, fields PackedElementField* 8, \
data bytes 9
RawImage: timestamp time 1, frame_id string 7, width fixed32 2, height fixed32 3, \
encoding string 4, step fixed32 5, data bytes 6
Log: timestamp time 1, level Level 2, message string 3, name string 4, file string 5, \
line fixed32 6
Level = UNKNOWN 0, DEBUG 1, INFO 2, WARNING 3, ERROR 4, FATAL 5
ArrowPrimitive: pose Pose 1, shaft_length double 2, shaft_diameter double 3, \
head_length double 4, head_diameter double 5, color Color 6
CubePrimitive: pose Pose 1, size Vector3 2, color Color 3
SpherePrimitive: pose Pose 1, size Vector3 2, color Color 3
CylinderPrimitive: pose Pose 1, size Vector3 2, bottom_scale double 3, top_scale double 4, \
color Color 5
LinePrimitive: type Type 1, pose Pose 2, thickness double 3, scale_invariant bool 4, \
points Point3* 5, color Color 6, colors Color* 7, indices fixed32* 8
Type = LINE_STRIP 0, LINE_LOOP 1, LINE_LIST 2
TriangleListPrimitive: pose Pose 1, points Point3* 2, color Color 3, colors Color* 4, \
indices fixed32* 5
TextPrimitive: pose Pose 1, billboard bool 2, font_size double 3, scale_invariant bool 4, \
color Color 5, text string 6
ModelPrimitive: pose Pose 1, scale Vector3 2, color Color 3, override_color bool 4, url string 5, \
media_type string 6, data bytes 7
SceneEntityDeletion: timestamp time 1, type Type 2, id string 3
Type = MATCHING_ID 0, ALL 1
SceneEntity: timestamp time 1, frame_id string 2, id string 3, lifetime span 4, \
frame_locked bool 5, metadata KeyValuePair* 6, arrows ArrowPrimitive* 7, cubes CubePrimitive* 8, \
spheres SpherePrimitive* 9, cylinders CylinderPrimitive* 10, lines LinePrimitive* 11, \
triangles TriangleListPrimitive* 12, texts TextPrimitive* 13, models ModelPrimitive* 14
SceneUpdate: deletions SceneEntityDeletion* 1, entities SceneEntity* 2
"""
"""A message or, with =, an enumeration of the message above it. A star: repeated."""

_FIELD = descriptor_pb2.FieldDescriptorProto
PLAIN: Final = {
    "double": _FIELD.TYPE_DOUBLE,
    "fixed32": _FIELD.TYPE_FIXED32,
    "bool": _FIELD.TYPE_BOOL,
    "string": _FIELD.TYPE_STRING,
    "bytes": _FIELD.TYPE_BYTES,
}


@cache
def classes() -> dict[str, Any]:
    """By name without the package, the classes of all messages."""
    # A pool of their own: others may bring the generated modules, with the same names.
    pool = descriptor_pool.DescriptorPool()
    for file in _files():
        pool.Add(file)  # type: ignore[no-untyped-call,unused-ignore]
    return {
        message.name: message_factory.GetMessageClass(
            pool.FindMessageTypeByName(f"{PACKAGE}.{message.name}")  # type: ignore[no-untyped-call,unused-ignore]
        )
        for message in _schemas().message_type
    }


@cache
def schema() -> bytes:
    """What stands in an MCAP file as the schema of each: a FileDescriptorSet with all of them."""
    described = descriptor_pb2.FileDescriptorSet(file=_files())
    return bytes(described.SerializeToString(deterministic=True))


def _files() -> list[Any]:
    found = []
    for known in (timestamp_pb2, duration_pb2):
        file = descriptor_pb2.FileDescriptorProto()
        known.DESCRIPTOR.CopyToProto(file)
        found.append(file)
    return [*found, _schemas()]


def _schemas() -> Any:
    file = descriptor_pb2.FileDescriptorProto(
        name="foxglove/schemas.proto", package=PACKAGE, syntax="proto3"
    )
    file.dependency.extend([timestamp_pb2.DESCRIPTOR.name, duration_pb2.DESCRIPTOR.name])
    lines = SCHEMAS.strip().splitlines()
    enums = {line.partition(" =")[0] for line in lines if " = " in line}
    for line in lines:
        if " = " in line:
            name, _, values = line.partition(" = ")
            enum = file.message_type[-1].enum_type.add(name=name)
            for value in values.split(", "):
                text, number = value.split(" ")
                enum.value.add(name=text, number=int(number))
        else:
            name, _, fields = line.partition(": ")
            message = file.message_type.add(name=name)
            for field in fields.split(", "):
                _add(message, enums, *field.split(" "))
    return file


def _add(message: Any, enums: set[str], name: str, kind: str, number: str) -> None:
    field = message.field.add(name=name, number=int(number))
    bare = kind.removesuffix("*")
    field.label = _FIELD.LABEL_REPEATED if bare != kind else _FIELD.LABEL_OPTIONAL
    if bare in PLAIN:
        field.type = PLAIN[bare]
    elif bare in enums:
        field.type = _FIELD.TYPE_ENUM
        field.type_name = f".{PACKAGE}.{message.name}.{bare}"
    else:
        field.type = _FIELD.TYPE_MESSAGE
        field.type_name = {"time": TIME, "span": SPAN}.get(bare, f".{PACKAGE}.{bare}")
