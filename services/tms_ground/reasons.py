"""Reasons why a ground cannot be read or used."""

from tms_reason.quantities import Megabytes, Metres, Percent, Seconds, SquareMetres
from tms_reason.reason import Reason
from tms_reason.remedies import EDIT_CONFIG, Remedy

CONVERT = Remedy("convert", "", "Convert the file")
EXPORT_AGAIN = Remedy("convert", "", "Export it again")
COPY_AGAIN = Remedy("copy", "", "Copy it again")
RIGHT_FILE = Remedy("file", "", "Give another file")
SAY_EPSG = Remedy(
    "epsg", "", "Give the EPSG code of its coordinates with --epsg, or --map where they are those of `map`"
)
OTHER_EPSG = Remedy("epsg", "", "Give another code with --epsg")
SMALLER_AREA = Remedy("area", "", "Give a file of the whole area, or a smaller --area")
KEEP_HOLES = Remedy("holes", "", "Take a larger --cell, or keep them as unknown with --keep-holes")
COARSER = Remedy("cell", "", "Take a larger --cell")
CHOOSE_SURFACE = Remedy("surface", "", "Choose one with --surface")
SAY_SIZE = Remedy("size", "", "Give --width, --height and --elevation in metres")


# fmt: off
# the site file
class WhereIsOrigin(Reason, text="needs either plane, north and east, or latitude and longitude", action=EDIT_CONFIG):
    pass
class AreaInsideOut(Reason, text="must be [least x, least y, largest x, largest y]", action=EDIT_CONFIG): pass
class OneDesign(Reason, text="needs one of plane, pit and file", action=EDIT_CONFIG): pass
class NoGround(Reason, text="there is no ground:, which tells the site's area", action=EDIT_CONFIG): pass
class NoSoil(Reason, text="there is no soil '{soil}' (there: {soils})", action=EDIT_CONFIG):
    soil: str; soils: tuple[str, ...]
class GroundOther(Reason, text="the kept ground is one of another area or soil: it is put aside as {file}"): file: str
class GroundNotKept(Reason, text="{file}: the ground cannot be kept there ({problem})"): file: str; problem: str
class GroundDamaged(Reason,
    text="the kept ground cannot be read ({problem}) and is put aside as {file}: buckets and vessels count as empty, "
    "heights are those of the newest snapshot"): file: str; problem: str
class GroundGone(Reason,
    text="the file of the ground is gone: buckets and vessels count as empty, "
    "heights are those of the newest snapshot"): pass
class GroundAway(Reason,
    text="nobody looked at the ground for {missing}: soil that machines moved then is estimated where it can be, else "
    "missing in the work figures (unseen)"): missing: Seconds
class WorkLost(Reason,
    text="the kept work cannot be read ({problem}): finished cycles that the database does not have yet are lost, the "
    "next ones have numbers from the clock, so that they replace none"): problem: str
class CycleLost(Reason, text="the database refuses a finished cycle for good: {why}"): why: Reason
class CyclesMany(Reason, text="too many cycles wait for the database: the oldest {lost} of them are lost"): lost: int
class NoOrigin(Reason, text="the file is in EPSG {epsg}, and the site file tells no ground.origin", action=EDIT_CONFIG):
    epsg: int
class NotAlongPlane(Reason, text="a GeoTIFF needs a ground.origin on a plane, without yaw: export an .asc"): pass

# what others ask of the ground
class NotAnArea(Reason, text="the rectangle [{x0}, {y0}, {x1}, {y1}] is none on the site"):
    x0: Metres; y0: Metres; x1: Metres; y1: Metres
class BadCell(Reason, text="cells of {cell} are asked for: {least} to {most} are possible"):
    cell: Metres; least: Metres; most: Metres

# grounds in the database, and what somebody has measured
class GroundFromFuture(Reason,
    text="the ground of {time} ({source}) lies in the future and is not taken: a clock has gone back"):
    time: str; source: str

class SeenFromFuture(Reason, text="measured heights lie {ahead} in the future and are not taken: a clock is wrong"):
    ahead: Seconds
class SeenNotHeights(Reason, text="measured heights are none: {problem}"): problem: str

# files of heights
class GroundFile(Reason, text="{file}: {why}"): file: str; why: Reason
class GroundFileMissing(Reason, text="there is no such file", action=RIGHT_FILE): pass
class GroundFileKind(Reason, text="is none of {endings}", action=CONVERT): endings: tuple[str, ...]
class GroundFileLarge(Reason, text="is {size}, {limit} are allowed", action=EXPORT_AGAIN):
    size: Megabytes; limit: Megabytes
class ManyPixels(Reason, text="has {width} x {height} pixels, {limit} are allowed in all", action=EXPORT_AGAIN):
    width: int; height: int; limit: int
class GroundFileDamaged(Reason, text="cannot be read ({problem})", action=COPY_AGAIN): problem: str
class ImageNeedsSize(Reason, text="an image does not tell how large it is", action=SAY_SIZE): pass
class ImageNotGrey(Reason, text="a heightmap has 8-bit or 16-bit grey pixels, not those of mode {mode}",
    action=CONVERT): mode: str
class GridKeyMissing(Reason, text="its head does not tell {key}", action=EXPORT_AGAIN): key: str
class GridKeyValue(Reason, text="its head tells {key} {value}", action=EXPORT_AGAIN): key: str; value: str
class GridSize(Reason, text="has {rows} rows of {columns} heights, its head tells {told_rows} of {told_columns}",
    action=COPY_AGAIN): rows: int; columns: int; told_rows: int; told_columns: int
class TiffNotPlaced(Reason, text="is no GeoTIFF: its tags do not tell where it lies", action=EXPORT_AGAIN): pass
class TiffTurned(Reason, text="its pixels are turned against its coordinates", action=CONVERT): pass
class TiffBands(Reason, text="has pixels of mode {mode}, not one height each", action=CONVERT): mode: str
class CloudEmpty(Reason, text="holds no points", action=RIGHT_FILE): pass
class CloudEndsEarly(Reason, text="ends before its {count} points are complete", action=COPY_AGAIN): count: int
class NoSurface(Reason, text="holds no surface of triangles (TIN)", action=EXPORT_AGAIN): pass
class ManySurfaces(Reason, text="holds several surfaces: {names}", action=CHOOSE_SURFACE):
    names: tuple[str, ...]
class SurfaceUnknown(Reason, text="holds no surface '{name}', only {names}", action=CHOOSE_SURFACE):
    name: str; names: tuple[str, ...]
class PointUnreadable(Reason, text="line {line}: a point is '{value}', not north, east and height",
    action=EXPORT_AGAIN): line: int; value: str
class FaceUnreadable(Reason, text="line {line}: a triangle has the corners '{value}'", action=EXPORT_AGAIN):
    line: int; value: str
class XmlUnreadable(Reason, text="is no XML ({problem})", action=COPY_AGAIN): problem: str
class LengthUnit(Reason, text="its lengths are in '{unit}', not in metres", action=CONVERT): unit: str

# coordinates and heights
class FrameNotTold(Reason, text="does not tell in which coordinates it is", action=SAY_EPSG): pass
class FramesDiffer(Reason, text="is in EPSG {told}, not {given}", action=OTHER_EPSG): told: int; given: str
class FrameUnknown(Reason, text="there are no coordinates with the EPSG code {epsg}", action=OTHER_EPSG): epsg: int
class FrameUnits(Reason, text="coordinates of EPSG {epsg} are in '{unit}', not in metres or degrees", action=CONVERT):
    epsg: int; unit: str
class NotOnSite(Reason, text="covers {covered} of the area ({area}), it reaches over {bounds}", action=SMALLER_AREA):
    covered: Percent; area: str; bounds: str
class HasHoles(Reason, text="{unknown} of {whole} have no height, the first at ({x}, {y})", action=KEEP_HOLES):
    unknown: SquareMetres; whole: SquareMetres; x: Metres; y: Metres
class NotMetres(Reason, text="its heights reach from {least} to {most}: are they in metres?", action=CONVERT):
    least: Metres; most: Metres
class ManyCells(Reason, text="{cells} cells of {cell} are more than {limit}", action=COARSER):
    cells: int; cell: Metres; limit: int
# fmt: on
