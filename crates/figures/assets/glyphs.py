"""Writes glyphs.txt: outlines of the characters that figures use, from DejaVu Sans.

    pip install fonttools && python3 glyphs.py /path/to/DejaVuSans.ttf > glyphs.txt

One line per character: code point, advance, and the outline in SVG's path commands with absolute coordinates, y upwards,
all in font units. The first line has the units per em.
"""

import sys

from fontTools.pens.basePen import BasePen
from fontTools.ttLib import TTFont

CHARACTERS = sorted(
    {chr(c) for c in range(0x20, 0x7F)}
    | {chr(c) for c in range(0xA1, 0x180) if c != 0xAD}
    | set("ΓΔΘΛΞΠΣΦΨΩαβγδεζηθικλμνξοπρςστυφχψω")
    | set("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻₀₁₂₃₄₅₆₇₈₉")
    | set("ẋẍẏÿ–—‘’“”…−×·±≤≥≈≠∞∈∑√∂‖→←↑↓↦□°′″")
)


class Commands(BasePen):
    """Absolute SVG path commands; curves stay quadratic, as TrueType has them."""

    def __init__(self, glyphs):
        super().__init__(glyphs)
        self.words = []

    def _add(self, letter, *points):
        self.words.append(letter + " ".join(f"{round(x)} {round(y)}" for x, y in points))

    def _moveTo(self, point):
        self._add("M", point)

    def _lineTo(self, point):
        self._add("L", point)

    def _qCurveToOne(self, control, point):
        self._add("Q", control, point)

    def _closePath(self):
        self.words.append("Z")


font = TTFont(sys.argv[1])
names, glyphs, widths = font.getBestCmap(), font.getGlyphSet(), font["hmtx"]
print(font["head"].unitsPerEm)
for character in CHARACTERS:
    name = names[ord(character)]
    pen = Commands(glyphs)
    glyphs[name].draw(pen)
    print(f"{ord(character):04X} {widths[name][0]} {''.join(pen.words)}".rstrip())
