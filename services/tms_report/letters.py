"""The font of plots and PDF, which has Japanese and Latin letters.

A font that this PC has (Debian: fonts-ipaexfont-gothic, in the site's image) is embedded into the PDF, which then looks
the same everywhere. Without one the PDF names a font of Adobe's collection, for which readers take one of their own:
those of a PC without any Japanese font show nothing.
"""

from functools import cache
from pathlib import Path

from reportlab.pdfbase import pdfmetrics
from reportlab.pdfbase.cidfonts import UnicodeCIDFont
from reportlab.pdfbase.ttfonts import TTFont

FOLDER = Path("/usr/share/fonts")
FILES = ("ipaexg.ttf", "ipag.ttf")  # IPAex Gothic, IPA Gothic: their outlines are TrueType, which reportlab embeds
NOT_EMBEDDED = "HeiseiKakuGo-W5"


@cache
def font() -> str:
    """The name of the font, which is then known to reportlab."""
    found = next((path for name in FILES for path in sorted(FOLDER.rglob(name))), None)
    made = UnicodeCIDFont(NOT_EMBEDDED) if found is None else TTFont(found.stem, str(found))
    pdfmetrics.registerFont(made)
    name: str = made.fontName
    return name
