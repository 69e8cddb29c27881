"""Waves in the case file: regular after Airy or Stokes, irregular after JONSWAP or Pierson and Moskowitz."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field, TypeAdapter, ValidationError

from ..water.waves import Spreading, Waves, airy, breaking_height, default_gamma, irregular, stokes2
from ..water.waves.limits import MICHE, wave_length
from .fields import Angle, Table, whole
from .places import Path
from .quantity import Quantity
from .units import LENGTH, TIME

MOST_COMPONENTS, MOST_DIRECTIONS = 10_000, 360
_LARGEST_SEED = 2**63 - 1  # of a whole number in TOML
# Shallower water holds no wave that a case file may have.
_LEAST_DEPTH = 1e-6  # m

Finding = tuple[Path, str, str, str]  # path, found, allowed, cure
Height = Annotated[float, Quantity(LENGTH, 1e-4, 100.0)]
Period = Annotated[float, Quantity(TIME, 0.01, 1000.0)]
RampTime = Annotated[float, Quantity(TIME, 0.0, 1e6)]


class SpreadingSpec(Table):
    """Directions of an irregular sea, by the energy cos^2s of half the angle off the mean direction."""

    exponent: Annotated[float, Quantity(None, 0.5, 1000.0)] = Field(
        description="s: some 5 to 30 for wind seas, 75 for swell", examples=[10]
    )
    directions: Annotated[int, *whole(2, MOST_DIRECTIONS)] = Field(
        default=15, description="how many; each component has one of them", examples=[15]
    )


class _Sea(Table, ABC):
    """What every sea has."""

    direction: Angle = Field(
        default=0.0, description="in which the waves go, from +x turning to +y", examples=["0 deg"]
    )
    ramp: RampTime = Field(
        default=0.0, description="s, over which the waves grow from nothing", examples=["10 s"]
    )

    @abstractmethod
    def sea(self, depth: float | None, gravity: float) -> Waves:
        """Return the waves in a depth (m), None for deep water."""

    @property
    @abstractmethod
    def height_and_period(self) -> tuple[str, float, float]:
        """Key of the height that breaking limits, its value (m), and the period (s) that goes with it."""

    @property
    @abstractmethod
    def described(self) -> str:
        """The waves in one line."""


class AirySpec(_Sea):
    """Linear regular waves."""

    kind: Literal["airy"] = Field(description="kind of waves", examples=["airy"])
    height: Height = Field(description="m, crest to trough", examples=[2.0])
    period: Period = Field(description="s", examples=["8 s"])
    phase: Angle = Field(default=0.0, description="at x = y = 0 at time 0; 0 is a crest", examples=["0 deg"])
    stretching: Literal["wheeler", "none"] = Field(
        default="wheeler", description="of the motion up to the surface", examples=["wheeler"]
    )

    def sea(self, depth: float | None, gravity: float) -> Waves:
        """Return the waves in a depth (m), None for deep water."""
        return airy(
            self.height,
            self.period,
            direction=self.direction,
            phase=self.phase,
            depth=_infinite(depth),
            gravity=gravity,
            stretching=self.stretching,
            ramp=self.ramp,
        )

    @property
    def height_and_period(self) -> tuple[str, float, float]:
        """Key, height (m) and period (s)."""
        return "height", self.height, self.period

    @property
    def described(self) -> str:
        """The waves in one line."""
        return f"airy, {self.height:g} m, {self.period:g} s, {_towards(self.direction)}"


class StokesSpec(_Sea):
    """Regular waves of Stokes' second order, which need no stretching."""

    kind: Literal["stokes2"] = Field(description="kind of waves", examples=["stokes2"])
    height: Height = Field(description="m, crest to trough", examples=[2.0])
    period: Period = Field(description="s", examples=["8 s"])
    phase: Angle = Field(default=0.0, description="at x = y = 0 at time 0; 0 is a crest", examples=["0 deg"])

    def sea(self, depth: float | None, gravity: float) -> Waves:
        """Return the waves in a depth (m), None for deep water."""
        return stokes2(
            self.height,
            self.period,
            direction=self.direction,
            phase=self.phase,
            depth=_infinite(depth),
            gravity=gravity,
            ramp=self.ramp,
        )

    @property
    def height_and_period(self) -> tuple[str, float, float]:
        """Key, height (m) and period (s)."""
        return "height", self.height, self.period

    @property
    def described(self) -> str:
        """The waves in one line."""
        return f"stokes2, {self.height:g} m, {self.period:g} s, {_towards(self.direction)}"


class _Irregular(_Sea):
    """What irregular seas have."""

    significant_height: Height = Field(description="m, Hs = 4 sqrt(m0)", examples=[2.0])
    peak_period: Period = Field(description="s, Tp", examples=["8 s"])
    components: Annotated[int, *whole(1, MOST_COMPONENTS)] = Field(
        default=200, description="waves that the sea is made of", examples=[200]
    )
    seed: Annotated[int, *whole(0, _LARGEST_SEED)] = Field(
        default=1, description="of the phases; the same seed gives the same sea", examples=[1]
    )
    spreading: SpreadingSpec | None = Field(
        default=None,
        description="of directions; all waves go one way without it",
        examples=[{"exponent": 10, "directions": 15}],
    )
    stretching: Literal["wheeler", "none"] = Field(
        default="wheeler", description="of the motion up to the surface", examples=["wheeler"]
    )

    @property
    @abstractmethod
    def peak_factor(self) -> float:
        """JONSWAP's gamma."""

    def sea(self, depth: float | None, gravity: float) -> Waves:
        """Return the waves in a depth (m), None for deep water."""
        spread = self.spreading
        return irregular(
            self.significant_height,
            self.peak_period,
            gamma=self.peak_factor,
            components=self.components,
            seed=self.seed,
            spreading=Spreading(spread.exponent, spread.directions) if spread else None,
            direction=self.direction,
            depth=_infinite(depth),
            gravity=gravity,
            stretching=self.stretching,
            ramp=self.ramp,
        )

    @property
    def height_and_period(self) -> tuple[str, float, float]:
        """Key, significant height (m) and peak period (s)."""
        return "significant_height", self.significant_height, self.peak_period

    def _described(self, name: str) -> str:
        spread = f", cos^2s spread, s = {self.spreading.exponent:g}" if self.spreading else ""
        return (
            f"{name}, Hs {self.significant_height:g} m, Tp {self.peak_period:g} s, "
            f"{self.components} components, {_towards(self.direction)}{spread}"
        )


class JonswapSpec(_Irregular):
    """An irregular sea that still grows, after JONSWAP."""

    kind: Literal["jonswap"] = Field(description="kind of waves", examples=["jonswap"])
    gamma: Annotated[float, Quantity(None, 1.0, 10.0)] | None = Field(
        default=None, description="peak factor; by Tp / sqrt(Hs) without it", examples=[3.3]
    )

    @property
    def peak_factor(self) -> float:
        """Gamma as given, or by Tp / sqrt(Hs)."""
        return default_gamma(self.significant_height, self.peak_period) if self.gamma is None else self.gamma

    @property
    def described(self) -> str:
        """The waves in one line."""
        return self._described(f"jonswap, gamma {self.peak_factor:.3g}")


class PiersonMoskowitzSpec(_Irregular):
    """A fully grown irregular sea, after Pierson and Moskowitz."""

    kind: Literal["pierson-moskowitz"] = Field(description="kind of waves", examples=["pierson-moskowitz"])

    @property
    def peak_factor(self) -> float:
        """Gamma of a grown sea."""
        return 1.0

    @property
    def described(self) -> str:
        """The waves in one line."""
        return self._described("pierson-moskowitz")


WavesSpec = Annotated[AirySpec | StokesSpec | JonswapSpec | PiersonMoskowitzSpec, Field(discriminator="kind")]
_READER: TypeAdapter[WavesSpec] = TypeAdapter(WavesSpec)


def wave_findings(waves: object, depth: float | None, gravity: float) -> Iterator[Finding]:
    """Say what is wrong with a [waves] table, valid by itself or not, in water of a depth (m) and gravity (m/s2)."""
    try:
        spec = _READER.validate_python(waves)
    except ValidationError:
        return
    if gravity <= 0.0:
        yield ("water", "gravity"), f"{gravity:g} m/s2, with waves", "gravity above 0", "leave out [waves]"
        return
    key, height, period = spec.height_and_period
    h = max(_infinite(depth), _LEAST_DEPTH)
    largest = breaking_height(period, h, gravity)
    if height > largest:
        length = wave_length(period, h, gravity)
        where = "deep water" if depth is None else f"{depth:g} m of water"
        found = f"{height:g} m, which makes H/L = {height / length:.3g} at {period:g} s in {where}"
        allowed = f"at most {_rounded_down(largest)} m, where waves break (H/L = {MICHE:g} tanh kh)"
        yield ("waves", key), found, allowed, "make the waves lower or the period longer; check the units"


def wave_oddities(
    spec: WavesSpec, *, depth: float | None, gravity: float, duration: float | None
) -> Iterator[str]:
    """Say what looks odd about the waves of a checked case; duration: s, of the run, None for a static case."""
    if duration is None:
        yield '[waves] plays no part in a static case; solve with kind = "dynamic" to have them.'
    elif spec.ramp > duration:
        yield f"The ramp of the waves takes {spec.ramp:g} s, longer than the run of {duration:g} s: they never grow up."
    yield from spec.sea(depth, gravity).warnings


def _infinite(depth: float | None) -> float:
    return math.inf if depth is None else depth


def _towards(direction: float) -> str:
    return f"towards {math.degrees(direction):g} deg"


def _rounded_down(value: float) -> str:
    """Four digits that are not above the value, so that the user can write them."""
    step = 10.0 ** (math.floor(math.log10(value)) - 3)
    return f"{math.floor(value / step) * step:.4g}"
