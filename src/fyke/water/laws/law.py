"""What every coefficient law says of itself, and what is said when it is used outside its range."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

Numbers = NDArray[Any]  # float64; complex where a derivative is checked by a complex step
Pair = tuple[Numbers, Numbers]

REYNOLDS, ANGLE, SOLIDITY = "Re", "angle", "solidity"
GAP_REYNOLDS = "Re/(1-Sn)"  # of the speed between the twines
PAPER_UNREAD = "in public code; the paper was not opened"


@dataclass(frozen=True)
class Range:
    """From which value to which a law is stated; quantity: one of the names above, angles in rad."""

    quantity: str
    low: float
    high: float

    def __str__(self) -> str:
        low, high = self._written(self.low), self._written(self.high)
        if self.low <= 0.0 and self.quantity != ANGLE:
            return f"{self.quantity} up to {high}"
        return f"{self.quantity} {low} to {high}"

    def _written(self, value: float) -> str:
        return f"{np.degrees(value):.4g} deg" if self.quantity == ANGLE else f"{value:.4g}"

    def sentence(self, law: str, values: ArrayLike, what: str) -> str | None:
        """Say how many of some values lie outside and which lies furthest; None when all lie inside."""
        found = np.atleast_1d(np.asarray(values, dtype=float))
        below, above = found < self.low, found > self.high
        count = int(np.count_nonzero(below | above))
        if not count:
            return None
        value = float(found[above].max() if above.any() else found[below].min())
        limit = self.high if above.any() else self.low
        side = "above" if above.any() else "below"
        where = f"{count} of {found.size} {what}" if found.size > 1 else what
        return (
            f"drag law '{law}' is used outside its range at {where}: {self.quantity} = {self._written(value)}, "
            f"{side} its limit of {self._written(limit)}"
        )


class Law:
    """A law of drag coefficients: a frozen dataclass whose fields are its parameters.

    name: the word for it in a case file; title: one line; area: what the coefficients are to be multiplied by;
    source: paper; read: how far it was read; stated: where it holds, empty where nothing is stated.
    """

    name: ClassVar[str]
    title: ClassVar[str]
    area: ClassVar[str]
    source: ClassVar[str]
    read: ClassVar[str] = PAPER_UNREAD
    stated: ClassVar[tuple[Range, ...]] = ()

    @property
    def ranges(self) -> tuple[Range, ...]:
        """Where the law holds with these parameters."""
        return self.stated


def outside(law: Law, what: str = "bars", **values: ArrayLike) -> tuple[str, ...]:
    """Return a sentence for every range of a law that values leave, with value, limit and how many.

    what: the word for the things that the values belong to; values: reynolds, angle (rad) or solidity, each any
    shape; a quantity without values is not judged.
    """
    given = {REYNOLDS: values.get("reynolds"), ANGLE: values.get("angle"), SOLIDITY: values.get("solidity")}
    if "reynolds" in values and "solidity" in values:
        given[GAP_REYNOLDS] = np.asarray(values["reynolds"]) / (1.0 - np.asarray(values["solidity"]))
    found = [
        one.sentence(law.name, numbers, what)
        for one in law.ranges
        if (numbers := given.get(one.quantity)) is not None
    ]
    return tuple(sentence for sentence in found if sentence)


class BarLaw(Law, ABC):
    """A law for one bar; angle: between bar and flow, pi/2 across (rad); lift: positive towards the bar's normal.

    The normal of the bar lies in the plane of bar and flow, on the side the water goes to.
    """

    area = "d l"

    @abstractmethod
    def force(self, reynolds: ArrayLike, angle: ArrayLike) -> Pair:
        """Return the force normal to and along the bar over 1/2 rho d l V^2; reynolds: d V / nu, V the speed."""

    def drag_lift(self, reynolds: ArrayLike, angle: ArrayLike) -> Pair:
        """Return C_D and C_L, along and across the flow, over 1/2 rho d l V^2."""
        normal, tangential = self.force(reynolds, angle)
        sine, cosine = np.sin(angle), np.cos(angle)
        return normal * sine + tangential * cosine, normal * cosine - tangential * sine


class SplitLaw(BarLaw):
    """A law of the flow across and the flow along a bar, each with a coefficient on its own speed squared."""

    @abstractmethod
    def coefficients(self, reynolds: ArrayLike, along: ArrayLike | None = None) -> Pair:
        """Return C_n and C_t, both on d l.

        reynolds: d v_n / nu with the speed across the bar; along: d v_t / nu, the same as across when left out.
        """

    @abstractmethod
    def derivative(self, reynolds: ArrayLike, along: ArrayLike | None = None) -> Pair:
        """Return the derivatives of C_n and C_t with respect to `reynolds`, at fixed `along` when it is given."""

    def force(self, reynolds: ArrayLike, angle: ArrayLike) -> Pair:
        """Return C_n sin^2 and C_t cos^2 at the Reynolds numbers of the two speeds."""
        sine, cosine = np.abs(np.sin(angle)), np.cos(angle)
        total = np.asarray(reynolds)
        normal, tangential = self.coefficients(total * sine, total * np.abs(cosine))
        return normal * sine**2, tangential * cosine * np.abs(cosine)


class AngleLaw(BarLaw):
    """A law of the angle of a bar: drag and lift on the whole speed squared."""

    @abstractmethod
    def drag_lift(self, reynolds: ArrayLike, angle: ArrayLike) -> Pair:
        """Return C_D and C_L, along and across the flow, over 1/2 rho d l V^2."""

    @abstractmethod
    def derivative(self, reynolds: ArrayLike, angle: ArrayLike) -> Pair:
        """Return the derivatives of C_D and C_L with respect to the Reynolds number."""

    def force(self, reynolds: ArrayLike, angle: ArrayLike) -> Pair:
        """Turn drag and lift into the axes of the bar."""
        drag, lift = self.drag_lift(reynolds, angle)
        sine, cosine = np.sin(angle), np.cos(angle)
        return drag * sine + lift * cosine, drag * cosine - lift * sine


class PanelLaw(Law, ABC):
    """A law for a plane panel of netting as a whole; angle: between its normal and the flow, 0 face on (rad).

    The normal points the way the water goes, so that the angle is at most pi/2; lift is positive towards the normal.
    """

    area = "outline"

    @abstractmethod
    def coefficients(self, angle: ArrayLike, solidity: ArrayLike = 0.0, reynolds: ArrayLike = 0.0) -> Pair:
        """Return C_D and C_L on `area`; reynolds: d V / nu with the undisturbed speed and the twine diameter."""


class KnotLaw(Law, ABC):
    """A law for a knot, taken as a sphere; shape: what a real knot has over a sphere of its diameter."""

    area = "pi d^2 / 4"

    @abstractmethod
    def coefficients(self, reynolds: ArrayLike) -> Numbers:
        """Return C_D on pi d^2 / 4; reynolds: d V / nu with the diameter of the knot."""

    @abstractmethod
    def derivative(self, reynolds: ArrayLike) -> Numbers:
        """Return the derivative of C_D with respect to the Reynolds number."""
