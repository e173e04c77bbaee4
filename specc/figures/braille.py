"""A drawing of dots in a terminal: each letter is two dots wide and four high (braille)."""

import math
from typing import Final, final

import numpy as np
from rich.text import Text

from runtime.arrays import Array, Booleans

BASE: Final = 0x2800
BITS: Final = np.array([[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]])
"""The dot of a letter at (row, column), as Unicode counts them."""


@final
class Canvas:
    """Dots over a rectangle of the world, and letters upon them; later strokes win a colour.

    Attributes:
        columns, rows: letters.
    """

    def __init__(
        self, columns: int, rows: int, box: tuple[float, float, float, float], *, ascii_only: bool
    ) -> None:
        """Fit `box` (least x and y, largest x and y) into so many letters, undistorted."""
        left, low, right, high = box
        self._scale = min((2 * columns - 1) / (right - left), (4 * rows - 1) / (high - low))
        self.columns = min(columns, math.ceil((self._scale * (right - left) + 1) / 2))
        self.rows = min(rows, math.ceil((self._scale * (high - low) + 1) / 4))
        self._left, self._high, self._ascii = left, high, ascii_only
        self._dots: Booleans = np.zeros((4 * self.rows, 2 * self.columns), dtype=np.bool_)
        self._styles = [[""] * self.columns for _ in range(self.rows)]
        self._letters: dict[tuple[int, int], str] = {}

    def copy(self) -> "Canvas":
        """The same drawing, to be drawn further upon."""
        other = object.__new__(Canvas)
        other.columns, other.rows = self.columns, self.rows
        other._scale, other._left, other._high = self._scale, self._left, self._high
        other._ascii = self._ascii
        other._dots = self._dots.copy()
        other._styles = [row.copy() for row in self._styles]
        other._letters = self._letters.copy()
        return other

    def stroke(self, points: Array, style: str = "", *, closed: bool = False) -> None:
        """A line through points (k, 2)."""
        corners = np.vstack([points, points[:1]]) if closed else points
        for (x, y), (to_x, to_y) in zip(corners[:-1].tolist(), corners[1:].tolist(), strict=True):
            count = math.ceil(self._scale * math.hypot(to_x - x, to_y - y)) + 1
            steps = np.linspace(0.0, 1.0, count + 1)
            self.dots(np.column_stack([x + steps * (to_x - x), y + steps * (to_y - y)]), style)

    def dots(self, points: Array, style: str = "") -> None:
        """A dot at each of the points (k, 2) that are on the canvas."""
        columns = np.round((points[:, 0] - self._left) * self._scale).astype(int)
        rows = np.round((self._high - points[:, 1]) * self._scale).astype(int)
        inside = (columns >= 0) & (columns < 2 * self.columns) & (rows >= 0)
        inside &= rows < 4 * self.rows
        self._dots[rows[inside], columns[inside]] = True
        cells = zip((rows[inside] // 4).tolist(), (columns[inside] // 2).tolist(), strict=True)
        for row, column in cells:
            self._styles[row][column] = style

    def letter(self, x: float, y: float, letter: str, style: str = "", shift: int = 0) -> None:
        """A letter over whatever dots are there, `shift` letters to the right of (x, y)."""
        column = round((x - self._left) * self._scale) // 2 + shift
        row = round((self._high - y) * self._scale) // 4
        if 0 <= row < self.rows and 0 <= column < self.columns:
            self._letters[row, column] = letter
            self._styles[row][column] = style

    def word(self, at: tuple[float, float], word: str, style: str = "", reach: float = 0.0) -> bool:
        """A word upon, above, below, or beside a place, where nothing is drawn; whether it fits.

        reach: how far what has this name reaches from its place.
        """
        column = round((at[0] - self._left) * self._scale) // 2
        row = round((self._high - at[1]) * self._scale) // 4
        middle = column - len(word) // 2
        tall, wide = (max(math.ceil(0.7 * reach * self._scale / dots), 1) for dots in (4, 2))
        places = [(row, middle)]
        for more in range(2):
            places += [(row - tall - more, middle), (row + tall + more, middle)]
            places += [(row, column + wide + more), (row, column - wide - more - len(word) + 1)]
        for top, first in places:
            cells = [(top, first + place) for place in range(len(word))]
            beside = {(top, first - 1), (top, first + len(word))}
            if all(map(self._is_free, cells)) and not beside & self._letters.keys():
                self._letters |= dict(zip(cells, word, strict=True))
                for _, place in cells:
                    self._styles[top][place] = style
                return True
        return False

    def _is_free(self, cell: tuple[int, int]) -> bool:
        """Whether a letter is on the canvas, and nothing is drawn there."""
        row, column = cell
        if not (0 <= row < self.rows and 0 <= column < self.columns) or cell in self._letters:
            return False
        return not self._dots[4 * row : 4 * row + 4, 2 * column : 2 * column + 2].any()

    def text(self) -> Text:
        """All of it, line by line."""
        blocks = self._dots.reshape(self.rows, 4, self.columns, 2)
        codes = np.einsum("rica,ia->rc", blocks.astype(int), BITS)
        shown = Text(no_wrap=True, end="")
        for row in range(self.rows):
            for column, code in enumerate(codes[row].tolist()):
                letter = self._letters.get((row, column)) or self._glyph(code)
                shown.append(letter, self._styles[row][column] if letter != " " else "")
            if row < self.rows - 1:
                shown.append("\n")
        return shown

    def _glyph(self, code: int) -> str:
        if not code:
            return " "
        return "#" if self._ascii else chr(BASE + code)
