"""How kernels are compiled, and whether they are compiled yet."""

from __future__ import annotations

from typing import Any

# NaN and infinity keep their meaning (no nnan, no ninf), so that a fault is seen where it happens; the other
# relaxations let the compiler use vector instructions and are the same in every run on one machine.
OPTIONS: dict[str, Any] = {
    "cache": True,
    "fastmath": {"contract", "arcp", "nsz", "reassoc"},
    "error_model": "numpy",
}
