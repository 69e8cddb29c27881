"""Lines free of netting in the case file: mooring lines, dropper lines, main lines; and the chain of some."""

from __future__ import annotations

from math import cos, pi, sin
from typing import Annotated, Any, Literal

from pydantic import Field, PlainValidator, WithJsonSchema

from ..netting.chain import chain
from ..netting.lines import LinePiece
from ..netting.twine import Twine
from .fields import Angle, Force, Length, Name, Table, whole
from .gear import Part
from .quantity import Quantity, wrong
from .units import LENGTH

MOST_PIECES, MOST_LINES = 1000, 1000  # segments of a piece, lines of one part
SEGMENTS = 20
_COORDINATE = Quantity(LENGTH, -1e6, 1e6)
_AN_END = (
    'a place [x, y, z], m, or a knot: "NAME:column-row" of netting, "NAME.EDGE[k]" along an edge, "NAME:k" of a rope, '
    "ring or line"
)

End = tuple[float, float, float] | str


def _read_end(value: Any) -> End:
    if isinstance(value, str) and value:
        return value
    if isinstance(value, list | tuple) and len(value) == 3:
        x, y, z = (_COORDINATE.read(one) for one in value)
        return x, y, z
    raise wrong(_AN_END, 'write for example [50.0, 0.0, -20.0] or "cage.top[0]"')


AnEnd = Annotated[
    End,
    PlainValidator(_read_end),
    WithJsonSchema({"anyOf": [{"type": "array", "minItems": 3, "maxItems": 3}, {"type": "string"}]}),
]


class ChainSpec(Table):
    """Steel chain, by the bar that its links are bent from."""

    bar_diameter: Length = Field(description="m, of the steel of its links", examples=["22 mm"])
    links: Literal["studless", "studded"] = Field(default="studless", description="with a stud across or not")
    breaking_strength: Force | None = Field(
        default=None, description="N, from the maker's table", examples=["300 kN"]
    )

    def twine(self, name: str) -> Twine:
        """Return the twine that it is taken as."""
        return chain(
            self.bar_diameter,
            stud=self.links == "studded",
            name=name,
            breaking_strength=self.breaking_strength,
        )


class LinePieceSpec(Table):
    """A piece of a line."""

    twine: Name = Field(description="name of a [twine.NAME] or a [chain.NAME]", examples=["chain"])
    length: Length = Field(description="m, unloaded", examples=["40 m"])
    segments: Annotated[int, *whole(1, MOST_PIECES)] = Field(
        default=SEGMENTS, description="straight bars that it is cut into", examples=[SEGMENTS]
    )


class LaidSpec(Part):
    """What every line says of itself."""

    twine: Name | None = Field(
        default=None, description="name of a [twine.NAME] or a [chain.NAME]", examples=["chain"]
    )
    length: Length | None = Field(default=None, description="m, unloaded", examples=["60 m"])
    pretension: Force | None = Field(
        default=None,
        description="N, instead of length: tension at its end (to) as it hangs in still water",
        examples=["2 kN"],
    )
    segments: Annotated[int, *whole(1, MOST_PIECES)] = Field(
        default=SEGMENTS, description="straight bars that it is cut into", examples=[SEGMENTS]
    )
    pieces: Annotated[tuple[LinePieceSpec, ...], Field(min_length=1)] | None = Field(
        default=None,
        description="instead of twine and length: its pieces from one end to the other",
        examples=[[{"twine": "chain", "length": "40 m"}, {"twine": "rope", "length": "20 m"}]],
    )

    @property
    def asked(self) -> tuple[LinePieceSpec, ...]:
        """Its pieces as they are given; one of no known length where a pretension makes it."""
        if self.pieces is not None:
            return self.pieces
        if self.twine is None or self.length is None:
            return ()
        return (LinePieceSpec(twine=self.twine, length=self.length, segments=self.segments),)

    @property
    def bars(self) -> int:
        """How many bars one line has."""
        return sum(piece.segments for piece in self.asked) or self.segments

    def made(self, twines: dict[str, Twine]) -> list[LinePiece]:
        """Return its pieces of the twines of the case; none where a pretension makes the length."""
        return [LinePiece(twines[one.twine], one.length, one.segments) for one in self.asked]


class LineSpec(LaidSpec):
    """A line from one place or knot to another."""

    kind: Literal["line"] = Field(description="kind of gear", examples=["line"])
    begin: AnEnd = Field(
        alias="from",
        description="where it begins: [x, y, z], m, z up from still water, or a knot",
        examples=[[60.0, 0.0, -20.0]],
    )
    end: AnEnd = Field(alias="to", description="where it ends, as from", examples=["cage.top[0]"])
    fixed: Literal["both", "from", "to", "none"] = Field(
        default="both", description="which of its ends that are places are held, as anchors are"
    )

    @property
    def held(self) -> tuple[bool, bool]:
        """Whether its ends are held where they are places."""
        return self.fixed in ("both", "from"), self.fixed in ("both", "to")


class MooringsSpec(LaidSpec):
    """Mooring lines evenly around a rim, each from an anchor on the sea bed."""

    kind: Literal["moorings"] = Field(description="kind of gear", examples=["moorings"])
    around: str = Field(
        description="edge that they are made fast to, NAME.EDGE of netting that closes round, or the name of a ring",
        examples=["cage.top"],
    )
    count: Annotated[int, *whole(1, MOST_LINES)] = Field(description="how many lines", examples=[8])
    radius: Length = Field(
        description="m, of the circle of anchors about the middle of the rim", examples=["80 m"]
    )
    bearing: Angle = Field(
        default=0.0, description="of the first anchor, from +x turning to +y", examples=["22.5 deg"]
    )

    def names(self, name: str) -> list[str]:
        """Return the names of its lines where it has this name itself."""
        return [f"{name} {number}".strip() for number in range(1, self.count + 1)]

    def anchors(self, middle: tuple[float, float], depth: float) -> list[tuple[float, float, float]]:
        """Return where its anchors are (m), for a rim about a middle (x, y) in water of a depth (m)."""
        angles = [self.bearing + 2.0 * pi * number / self.count for number in range(self.count)]
        return [
            (middle[0] + self.radius * cos(angle), middle[1] + self.radius * sin(angle), -depth)
            for angle in angles
        ]
