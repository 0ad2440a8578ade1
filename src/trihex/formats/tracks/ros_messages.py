"""ROS messages: the definitions of those that a recording holds, as ROS 2 has had them since Humble."""

from __future__ import annotations

_SEPARATOR = "=" * 80
# Each message, its fields one after the other, without constants, comments and defaults.
_FIELDS = {
    "nav_msgs/OccupancyGrid": "std_msgs/Header header, nav_msgs/MapMetaData info, int8[] data",
    "nav_msgs/MapMetaData": "builtin_interfaces/Time map_load_time, float32 resolution, uint32 width, uint32 height, "
    "geometry_msgs/Pose origin",
    "nav_msgs/Path": "std_msgs/Header header, geometry_msgs/PoseStamped[] poses",
    "geometry_msgs/PoseArray": "std_msgs/Header header, geometry_msgs/Pose[] poses",
    "geometry_msgs/PoseStamped": "std_msgs/Header header, geometry_msgs/Pose pose",
    "geometry_msgs/Pose": "geometry_msgs/Point position, geometry_msgs/Quaternion orientation",
    "geometry_msgs/Point": "float64 x, float64 y, float64 z",
    "geometry_msgs/Vector3": "float64 x, float64 y, float64 z",
    "geometry_msgs/Quaternion": "float64 x, float64 y, float64 z, float64 w",
    "visualization_msgs/MarkerArray": "visualization_msgs/Marker[] markers",
    "visualization_msgs/Marker": "std_msgs/Header header, string ns, int32 id, int32 type, int32 action, "
    "geometry_msgs/Pose pose, geometry_msgs/Vector3 scale, std_msgs/ColorRGBA color, "
    "builtin_interfaces/Duration lifetime, bool frame_locked, geometry_msgs/Point[] points, "
    "std_msgs/ColorRGBA[] colors, string texture_resource, sensor_msgs/CompressedImage texture, "
    "visualization_msgs/UVCoordinate[] uv_coordinates, string text, string mesh_resource, "
    "visualization_msgs/MeshFile mesh_file, bool mesh_use_embedded_materials",
    "visualization_msgs/UVCoordinate": "float32 u, float32 v",
    "visualization_msgs/MeshFile": "string filename, uint8[] data",
    "sensor_msgs/CompressedImage": "std_msgs/Header header, string format, uint8[] data",
    "std_msgs/ColorRGBA": "float32 r, float32 g, float32 b, float32 a",
    "std_msgs/Header": "builtin_interfaces/Time stamp, string frame_id",
    "builtin_interfaces/Time": "int32 sec, uint32 nanosec",
    "builtin_interfaces/Duration": "int32 sec, uint32 nanosec",
}

# Of markers: their types and actions.
CYLINDER, LINE_STRIP = 3, 4
ADD, DELETEALL = 0, 3


def definition_of(message: str) -> str:
    """Return the definition of a message, followed by those of all that it holds.

    Examples
    --------
    >>> print(definition_of("std_msgs/Header"))
    builtin_interfaces/Time stamp
    string frame_id
    ================================================================================
    MSG: builtin_interfaces/Time
    int32 sec
    uint32 nanosec
    """
    parts, names = [], [message]
    for name in names:  # which grows
        fields = _FIELDS[name].split(", ")
        parts.append("\n".join(fields if name == message else [_SEPARATOR, f"MSG: {name}", *fields]))
        kinds = (field.split()[0].removesuffix("[]") for field in fields)
        names += [kind for kind in dict.fromkeys(kinds) if kind in _FIELDS and kind not in names]
    return "\n".join(parts)
