#!/usr/bin/python3
"""Writes src/view/tables.cpp anew.

Colours: viridis (van der Walt, Smith; CC0) and cividis (Nunez, Anderton, Renslow, PLoS ONE 13(7) e0199239, 2018; CC0), as in
python3-matplotlib. Font: misc-fixed 7x13 ("Public domain font. Share and enjoy."), e.g. from Debian's
xfonts-base: /usr/share/fonts/X11/misc/7x13.pcf.gz. Needs python3-matplotlib and python3-pil.
"""
import argparse
import gzip
import io
import pathlib

import matplotlib
from PIL import Image, PcfFontFile

VIEW = pathlib.Path(__file__).resolve().parent.parent / "src/view"
HEAD = "// Written by scripts/view_tables.py, which names the sources; not to be edited.\n// clang-format off\n"
WIDTH, HEIGHT, ASCENT = 7, 13, 11


def wrapped(values):
    lines = ["    " + "".join(f"{value}, " for value in values[i:i + 12]).rstrip() for i in range(0, len(values), 12)]
    return "\n".join(lines)


def colours(name):
    rgb = [round(255 * channel) for i in range(256) for channel in matplotlib.colormaps[name](i)[:3]]
    return f"const std::uint8_t k{name.capitalize()}[256 * 3] = {{\n{wrapped(rgb)}}};\n"


def rows(font, code):
    advance, box, _, glyph = font.glyph[code]
    cell = Image.new("1", (WIDTH, HEIGHT))
    cell.paste(glyph, (box[0], ASCENT + box[1]))
    return [sum(1 << x for x in range(WIDTH) if cell.getpixel((x, y))) for y in range(HEIGHT)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("font", metavar="FONT.pcf.gz")
    font_file = parser.parse_args().font
    body = "\n".join(colours(name) for name in ("viridis", "cividis"))
    font = PcfFontFile.PcfFontFile(io.BytesIO(gzip.open(font_file).read()))
    glyphs = [f"0x{row:02x}" for code in range(32, 127) for row in rows(font, code)]
    VIEW.joinpath("tables.cpp").write_text(
        f'{HEAD}\n#include "view/tables.h"\n\nnamespace fsr::view::tables {{\n\n{body}\n'
        f"const std::uint8_t kFont[95 * 13] = {{\n{wrapped(glyphs)}}};\n\n}}  // namespace fsr::view::tables\n")


main()
