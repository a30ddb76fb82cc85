"""``python -m hexhex [FILE]``: shows a mesh, or the mesh of a map, in a browser; without a file, opens the page that
makes meshes of maps and parts which are dropped on it."""

from __future__ import annotations

import pathlib
import sys
import tempfile
import webbrowser

import hexhex

_PAGE = pathlib.Path(__file__).with_name("hexhex.html")


def main(arguments: list[str]) -> str | None:
    """Returns what went wrong, if anything did."""
    if len(arguments) > 1 or arguments[:1] in (["-h"], ["--help"]):
        return "usage: python -m hexhex [FILE]"
    page = _PAGE
    try:
        if arguments:
            file = pathlib.Path(arguments[0])
            content = hexhex.read(file)
            mesh = content if isinstance(content, hexhex.Mesh) else hexhex.extract(content)
            page = pathlib.Path(tempfile.mkdtemp(prefix="hexhex-")) / f"{file.stem}.html"
            hexhex.write(mesh, page)
        elif not page.exists():
            return ("This package was built without the page hexhex.html (docs/user/browser.md). "
                    "`python -m hexhex FILE` shows a mesh.")
    except hexhex.HexhexError as error:
        return str(error)
    print(page.as_uri())
    webbrowser.open(page.as_uri())
    return None


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
