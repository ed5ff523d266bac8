"""One file of Japanese texts, for tests."""

from babel.messages.pofile import read_po

from tms_reason.texts import LOCALE


def catalogue(name: str) -> dict[str, str]:
    """English -> Japanese of `locale/ja/<name>.po`."""
    with (LOCALE / "ja" / f"{name}.po").open("rb") as file:
        return {str(one.id): str(one.string) for one in read_po(file, locale="ja") if one.id}
