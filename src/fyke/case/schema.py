"""The case file as a model: every table and key with its unit, range, default and an example to write."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, PrivateAttr

from ..netting.tubes import Tube
from ..netting.twine import MATERIALS, Material, Twine
from .added_mass import AddedMass
from .bed import BedSpec
from .box import BoxSpec
from .current import Current
from .drag import Drag, hung_solidity
from .fields import Force, Length, Name, Point, Table, Time, Title, Tolerance, whole
from .gear import NettingSpec, PanelSpec, Piece, Sheet
from .grouping import GroupingSpec, choose_groups
from .lines import ChainSpec, LaidSpec, LineSpec, MooringsSpec
from .load_case import LoadCaseSpec
from .motion import MotionSpec
from .quantity import Quantity, wrong
from .rigging import BodiesSpec, FloatsSpec, RopeSpec, SinkersSpec
from .seams import SeamSpec
from .shapes import ConeSpec, CylinderSpec, FrustumSpec
from .shelter import ShelterSpec
from .tapered import TrapezoidSpec, TriangleSpec
from .tubes import CollarSpec, RingSpec, TubeSpec, TubularSpec
from .twine import MaterialSpec, TwineSpec
from .units import ACCELERATION, DENSITY, ENERGY, VISCOSITY
from .waves import WavesSpec

MOST_PERIODS = 100


def _static_by_default(value: Any) -> Any:
    return {"kind": "static"} | value if isinstance(value, dict) else value


def _named_tables(what: str) -> Callable[[Any], Any]:
    def check(value: Any) -> Any:
        if isinstance(value, dict) and not any(isinstance(inner, dict) for inner in value.values()):
            raise wrong(f"tables with a name each, [{what}.NAME]", f"give the {what} a name: [{what}.main]")
        return value

    return check


class Water(Table):
    """The water."""

    density: Annotated[float, Quantity(DENSITY, 0.0, 1e5)] = Field(default=1000.0, description="kg/m3")
    kinematic_viscosity: Annotated[float, Quantity(VISCOSITY, 0.0, 1e3, open_below=True)] = Field(
        default=1.0e-6, description="m2/s; only Reynolds numbers use it"
    )
    gravity: Annotated[float, Quantity(ACCELERATION, 0.0, 1e3)] = Field(
        default=9.81, description="m/s2, downwards"
    )
    depth: Length | None = Field(
        default=None, description="m, from still water to the sea bed; deep water without it", examples=[20.0]
    )


class StaticSolve(Table):
    """Find the equilibrium."""

    kind: Literal["static"] = Field(default="static", description="static or dynamic", examples=["static"])
    tolerance: Force = Field(default=1e-8, description="N, largest unbalanced force on a free knot")


class DynamicSolve(Table):
    """Step in time from the net at rest."""

    kind: Literal["dynamic"] = Field(description="static or dynamic", examples=["dynamic"])
    tolerance: Force = Field(default=1e-8, description="N, of static cases; settle_force is for dynamic ones")
    duration: Time = Field(description="s, simulated time", examples=[2.0])
    start: Literal["built", "equilibrium"] = Field(
        default="built",
        description="begin with the net as built, or at its equilibrium in the water of time 0 without waves",
    )
    stepper: Literal["auto", "implicit", "newmark", "verner", "symplectic"] = Field(
        default="auto", description="time stepping method"
    )
    rtol: Tolerance | None = Field(
        default=None,
        description="relative error per step, of adaptive steppers; auto, implicit, newmark 1e-2, verner 1e-4",
        examples=[1e-3],
    )
    atol: Tolerance | None = Field(
        default=None,
        description="absolute error per step (m, m/s), of adaptive steppers; auto, implicit, newmark 1e-6, verner 1e-7",
        examples=[1e-6],
    )
    max_step: Time | None = Field(default=None, description="s, largest time step", examples=["1 ms"])
    settle_force: Force | None = Field(
        default=None, description="N, end early when no free knot is further out of balance", examples=[1e-6]
    )
    settle_energy: Annotated[float, Quantity(ENERGY, 0.0, 1e9, open_below=True)] | None = Field(
        default=None, description="J, end early when the kinetic energy stays below it", examples=["1 uJ"]
    )


Gear = Annotated[
    PanelSpec
    | TrapezoidSpec
    | TriangleSpec
    | CylinderSpec
    | ConeSpec
    | FrustumSpec
    | BoxSpec
    | SeamSpec
    | RopeSpec
    | LineSpec
    | MooringsSpec
    | RingSpec
    | CollarSpec
    | SinkersSpec
    | FloatsSpec,
    Field(discriminator="kind"),
]

SolveSpec = Annotated[
    Annotated[StaticSolve | DynamicSolve, Field(discriminator="kind")], BeforeValidator(_static_by_default)
]


class Output(Table):
    """What a run writes."""

    every: Time | None = Field(
        default=None, description="s between outputs, a hundredth of the duration by default", examples=[0.02]
    )
    probes: Annotated[tuple[Point, ...], Field(max_length=1000)] = Field(
        default=((0.0, 0.0, 0.0),),
        description="m, points at which a run in waves writes the motion of the water",
        examples=[[[0.0, 0.0, -1.0]]],
    )
    periods: Annotated[int, *whole(1, MOST_PERIODS)] | None = Field(
        default=None,
        description="so many of the slowest natural periods of a static case; none by default",
        examples=[6],
    )


class Compare(Table):
    """Measurements to lay over the result."""

    positions: str = Field(
        description='CSV file, beside the case file: columns knot,x,y,z (m), knot as row-column "i-j", '
        "or x0,y0,z0,x,y,z",
        examples=["measured.csv"],
    )


class Case(Table):
    """A whole case file in SI units.

    Made by load_case and parse_case, which also check what holds between tables and fill in text, path,
    warnings and the names and sizes of the gear.
    """

    schema_version: Literal[1] = Field(alias="schema", description="version of this format", examples=[1])
    title: Title = Field(default="", description="one line for figures and reports")
    water: Water = Field(default=Water(), description="the water")
    current: Current = Field(description="the current")
    waves: WavesSpec | None = Field(default=None, description="the waves")
    bed: BedSpec | None = Field(default=None, description="the sea bed, which bears what comes down to it")
    material: Annotated[dict[Name, MaterialSpec], BeforeValidator(_named_tables("material"))] = Field(
        default={}, description="materials of your own by name"
    )
    twine: Annotated[dict[Name, TwineSpec], BeforeValidator(_named_tables("twine"))] = Field(
        default={}, description="twines by name", examples=[{"main": {}}]
    )
    chain: Annotated[dict[Name, ChainSpec], BeforeValidator(_named_tables("chain"))] = Field(
        default={}, description="chains by name, for lines"
    )
    netting: Annotated[dict[Name, NettingSpec], BeforeValidator(_named_tables("netting"))] = Field(
        default={}, description="nettings by name"
    )
    tube: Annotated[dict[Name, TubeSpec], BeforeValidator(_named_tables("tube"))] = Field(
        default={}, description="tubes by name"
    )
    gear: Annotated[tuple[Gear, ...], Field(min_length=1)] = Field(
        description="panels, shapes, ropes, rings, collars, lines, sinkers and floats, one [[gear]] each"
    )
    grouping: GroupingSpec | None = Field(default=None, description="how fine the netting is laid")
    motion: tuple[MotionSpec, ...] = Field(default=(), description="how held knots move, one [[motion]] each")
    drag: Drag = Field(default=Drag(), description="coefficient laws of drag")
    added_mass: AddedMass = Field(default=AddedMass(), description="added mass coefficients")
    shelter: ShelterSpec = Field(default=ShelterSpec(), description="what netting takes of the current")
    solve: SolveSpec = Field(default=StaticSolve(), description="how to solve")
    output: Output = Field(default=Output(), description="what to write")
    compare: Compare | None = Field(default=None, description="measurements")
    load_case: tuple[LoadCaseSpec, ...] = Field(
        default=(), description="the same gear in other currents and waves, one [[load_case]] each"
    )
    chosen_load_case: Name | None = Field(
        default=None, description="name of the one load case that is meant, in place of [current] and [waves]"
    )
    _text: str = PrivateAttr(default="")
    _path: Path | None = PrivateAttr(default=None)
    _warnings: tuple[str, ...] = PrivateAttr(default=())

    def model_post_init(self, context: Any) -> None:
        """Take over what the file itself does not hold."""
        known = context or {}
        self._text = known.get("text", "")
        self._path = known.get("path")
        self._warnings = known.get("warnings", ())
        for twine in self.twine.values():
            twine.settle(self.materials)
        for number, part in enumerate(self.gear, 1):
            part.call(str(number) if len(self.gear) > 1 else "")
            if isinstance(part, Piece) and part.netting in self.netting:
                part.settle(self.netting[part.netting])
        made = [(one, self.netting[one.netting]) for one in self.pieces if one.netting in self.netting]
        for (piece, _), group in zip(
            made, choose_groups(made, self.grouping.knots if self.grouping else None), strict=True
        ):
            piece.gather(group)
        for motion in self.motion:
            motion.settle(self.folder)
        self.current.settle(self.folder, self.water.depth, static=self.solve.kind == "static")

    @property
    def text(self) -> str:
        """The case file as it was read."""
        return self._text

    @property
    def path(self) -> Path | None:
        """Where the case was read; None for a text."""
        return self._path

    @property
    def sha256(self) -> str:
        """SHA-256 of the case file, 64 hexadecimal digits."""
        return hashlib.sha256(self._text.encode()).hexdigest()

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is allowed but looks odd, sentences with the number and the limit."""
        return self._warnings

    @property
    def materials(self) -> dict[str, Material]:
        """The materials that twines can be made of, by name: those of fyke and those of the file."""
        return MATERIALS | {name: spec.material(name) for name, spec in self.material.items()}

    @property
    def twines(self) -> dict[str, Twine]:
        """The twines and chains of netting, ropes and lines, by name."""
        specs: dict[str, TwineSpec | ChainSpec] = {**self.twine, **self.chain}
        return {name: spec.twine(name) for name, spec in specs.items()}

    @property
    def tubes(self) -> dict[str, Tube]:
        """The tubes of rings and collars, by name."""
        own = {name: spec.material(name) for name, spec in self.material.items()}
        return {name: spec.tube(own) for name, spec in self.tube.items()}

    @property
    def folder(self) -> Path:
        """The folder that file names count from: of the case file, the present one for a text."""
        return self._path.parent if self._path else Path()

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """The gear that is netting."""
        return tuple(part for part in self.gear if isinstance(part, Piece))

    @property
    def seams(self) -> tuple[SeamSpec, ...]:
        """The gear that is seams."""
        return tuple(part for part in self.gear if isinstance(part, SeamSpec))

    @property
    def ropes(self) -> tuple[RopeSpec, ...]:
        """The gear that is ropes."""
        return tuple(part for part in self.gear if isinstance(part, RopeSpec))

    @property
    def lines(self) -> tuple[LaidSpec, ...]:
        """The gear that is lines free of netting, and moorings."""
        return tuple(part for part in self.gear if isinstance(part, LaidSpec))

    @property
    def tubulars(self) -> tuple[TubularSpec, ...]:
        """The gear that is made of tubes."""
        return tuple(part for part in self.gear if isinstance(part, TubularSpec))

    @property
    def bodies(self) -> tuple[BodiesSpec, ...]:
        """The gear that is floats and sinkers."""
        return tuple(part for part in self.gear if isinstance(part, BodiesSpec))

    @property
    def sheets(self) -> tuple[tuple[NettingSpec, Sheet], ...]:
        """Every sheet of netting of the gear, with what it is made of."""
        made = [(piece, self.netting[piece.netting]) for piece in self.pieces]
        return tuple((netting, sheet) for piece, netting in made for sheet in piece.sheets(netting))

    @property
    def solidity(self) -> float:
        """Solidity of the netting as it is hung, the mean by its areas."""
        solid, area = 0.0, 0.0
        for netting, sheet in self.sheets:
            outline = sheet.area(netting.mesh)
            solid += outline * hung_solidity(sheet, netting, self.twine[netting.twine].diameter)
            area += outline
        return solid / area if area else 0.0

    @property
    def positions_file(self) -> Path | None:
        """Measured positions to compare with; a relative name counts from the folder of the case file."""
        if self.compare is None:
            return None
        return self.folder / self.compare.positions


def json_schema() -> dict[str, Any]:
    """Return the JSON Schema (2020-12) of the case file, for editors that complete and check while typing."""
    schema = Case.model_json_schema(by_alias=True)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema, "title": "fyke case file"}
