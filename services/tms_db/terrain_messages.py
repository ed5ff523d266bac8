"""Terrain as ROS messages: images from PNG files, clouds from and to GridFS files."""

import io
from collections.abc import Mapping
from typing import Any

from sensor_msgs.msg import Image, PointCloud2, PointField

from tms_db.reasons import CloudForeign, CloudLarge, CloudSizes, ImageMode, ImageUnreadable
from tms_db.terrain_files import MAX_SIDE, bad

ENCODINGS = {"L": "mono8", "I;16": "mono16", "RGB": "rgb8", "RGBA": "rgba8"}  # Pillow's modes
CLOUD = ("height", "width", "is_bigendian", "point_step", "row_step", "is_dense")
MAX_CLOUD = 16 * 2**20  # bytes: some 500,000 points; more keeps the store from writing parameters for a second


def image(where: str, data: bytes) -> Image:
    """A PNG as sensor_msgs/Image.

    Raises:
        DbError: BAD_TERRAIN.
    """
    from PIL import Image as Pictures  # heavy, and needed here only

    try:
        with Pictures.open(io.BytesIO(data), formats=("PNG",)) as picture:
            if max(picture.size) > MAX_SIDE or picture.mode not in ENCODINGS:
                raise bad(ImageMode(where, str(picture.size), picture.mode))
            pixels = picture.tobytes()
            width, height = picture.size
            encoding = ENCODINGS[picture.mode]
    except (OSError, SyntaxError, ValueError) as error:
        raise bad(ImageUnreadable(where, str(error))) from error
    message = Image(width=width, height=height, encoding=encoding, step=len(pixels) // height)
    message.data.frombytes(pixels)  # the setter would check each byte
    return message


def cloud_head(message: PointCloud2) -> dict[str, Any]:
    """The fields that are stored with the bytes of a PointCloud2.

    Raises:
        DbError: BAD_TERRAIN; its sizes contradict each other, or it is too large.
    """
    if len(message.data) > MAX_CLOUD:
        raise bad(CloudLarge(len(message.data) / 2**20, MAX_CLOUD / 2**20))
    wanted = message.row_step * message.height
    if len(message.data) != wanted or message.row_step < message.point_step * message.width:
        raise bad(CloudSizes(len(message.data), wanted))
    head: dict[str, Any] = {name: getattr(message, name) for name in CLOUD}
    head["frame_id"] = message.header.frame_id
    head["stamp"] = {"sec": message.header.stamp.sec, "nanosec": message.header.stamp.nanosec}
    head["fields"] = [
        {"name": f.name, "offset": f.offset, "datatype": f.datatype, "count": f.count} for f in message.fields
    ]
    return {"cloud": head}


def cloud(where: str, head: Mapping[str, Any] | None, data: bytes) -> PointCloud2:
    """The PointCloud2 that was stored.

    Raises:
        DbError: BAD_TERRAIN; it was stored by another program.
    """
    if head is None:
        raise bad(CloudForeign(where))
    message = PointCloud2(**{name: head[name] for name in CLOUD})
    message.fields = [PointField(**field) for field in head["fields"]]
    message.header.frame_id = head["frame_id"]
    message.header.stamp.sec, message.header.stamp.nanosec = head["stamp"]["sec"], head["stamp"]["nanosec"]
    message.data.frombytes(data)
    return message
