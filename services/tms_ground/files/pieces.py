"""The compressed pieces of a LAZ: refuses sizes that do not fit, for lazrs would make room for all that they tell."""

from pathlib import Path

import laspy
import lazrs
import numpy as np

from tms_ground.reasons import GroundFileDamaged
from tms_reason.errors import TmsError

# Points of formats 6 to 10 are compressed field by field: a piece begins with its first point, the number of its
# points, and the sizes of its fields (LASzip, "layered" chunks). How many, without the extra bytes of a point:
FIELDS = {6: 9, 7: 10, 8: 11, 9: 10, 10: 12}
NUMBER = 4  # bytes


def refuse_false_sizes(path: Path, head: laspy.LasHeader) -> None:
    """Compare what the table of pieces, and each piece, tell of sizes.

    Raises:
        TmsError: they do not fit together.
        lazrs.LazrsError, OSError: the table cannot be read.
    """
    packing = next((one for one in head.vlrs if isinstance(one, laspy.vlrs.known.LasZipVlr)), None)
    fields = FIELDS.get(head.point_format.id)
    if packing is None or fields is None:
        return
    first, fields = head.point_format.size + NUMBER, fields + head.point_format.num_extra_bytes
    size = path.stat().st_size
    with path.open("rb") as file:
        file.seek(head.offset_to_point_data)
        table = lazrs.read_chunk_table(file, lazrs.LazVlr(packing.record_data))
        at = file.tell()
        for _, length in table:
            file.seek(at + first)
            told = int(np.frombuffer(file.read(NUMBER * fields), "<u4").sum(dtype=np.uint64))
            if first + NUMBER * fields + told > length or at + length > size:
                raise TmsError(GroundFileDamaged(f"{told} B > {length} B at {at}"))
            at += length
