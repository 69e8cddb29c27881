"""The commands that only write text: new, schema and cite."""

from __future__ import annotations

import json
import sys
import textwrap
from pathlib import Path

from ..case import Case, CaseError, Problem, json_schema, load_case, template
from ..system.system import System
from ..version import __version__
from .show import DONE, WRONG_INPUT, print_problems, stdout

METHODS = {
    "static": "equilibrium: primal-dual interior point with the corrector of S. Mehrotra, On the implementation of "
    "a primal-dual interior point method, SIAM J. Optim. 2(4), 575-601, 1992, on second-order cones scaled as in "
    "Y. Nesterov, M. Todd, Self-scaled barriers and interior-point methods for convex programming, Math. Oper. "
    "Res. 22(1), 1-42, 1997",
    "auto": "time stepping: whichever needs less work of BDF2 (E. Hairer, S.P. Norsett, G. Wanner, Solving ordinary "
    "differential equations I, section III.5, 1993) and leapfrog (E. Hairer, C. Lubich, "
    "G. Wanner, Acta Numerica 12, 399-450, 2003)",
    "implicit": "time stepping: backward differences of second order with variable steps (BDF2), E. Hairer, S.P. "
    "Norsett, G. Wanner, Solving ordinary differential equations I, section III.5, 1993",
    "newmark": "time stepping: average acceleration (beta 1/4, gamma 1/2), N.M. Newmark, A method of computation for "
    "structural dynamics, J. Eng. Mech. Div. ASCE 85, 67-94, 1959",
    "verner": "time stepping: Runge-Kutta pair of orders 5 and 6, J.H. Verner, Explicit Runge-Kutta methods with "
    "estimates of the local truncation error, SIAM J. Numer. Anal. 15(4), 772-790, 1978, as in T.E. Hull, "
    "W.H. Enright, K.R. Jackson, User's guide for DVERK, TR 100, Univ. Toronto, 1976",
    "symplectic": "time stepping: leapfrog, E. Hairer, C. Lubich, G. Wanner, Geometric numerical integration "
    "illustrated by the Stormer-Verlet method, Acta Numerica 12, 399-450, 2003",
}


def write_template(file: Path) -> int:
    """Write a case file to start from and return the exit code."""
    try:
        with file.open("x", encoding="utf-8") as new:
            new.write(template())
    except FileExistsError:
        found, cure = "a file of this name", "choose another name; fyke new never writes over a file"
    except OSError as error:
        found, cure = error.strerror or str(error), "choose another place"
    else:
        stdout().print(f"{file} is ready: change it, then: fyke run {file}", soft_wrap=True)
        return DONE
    print_problems([Problem(str(file), found, "a name for a new case file", cure)])
    return WRONG_INPUT


def print_schema() -> None:
    """Print the JSON Schema of the case file."""
    json.dump(json_schema(), sys.stdout, indent=2)
    sys.stdout.write("\n")


def sources_of(case: Case, system: System) -> tuple[str, ...]:
    """Where the laws, materials and methods of a case come from, one line each."""
    used = {twine.material for twine in case.twine.values() if twine.material and twine.takes_from_material}
    materials = [f"material {name}: {case.materials[name].source}" for name in sorted(used)]
    method = case.solve.stepper if case.solve.kind == "dynamic" else "static"
    return (*system.sources, *materials, METHODS[method])


def print_sources(file: Path) -> int:
    """Print where the laws, materials and methods of a case come from and return the exit code."""
    from ..system.build import build_net, build_system

    try:
        case = load_case(file)
        system = build_system(build_net(case), case)
    except CaseError as error:
        print_problems(error.problems)
        return WRONG_INPUT
    console = stdout()
    console.print(f"Computed with fyke {__version__}, built on:")
    for source in sources_of(case, system):
        console.print(textwrap.fill(source, console.width, initial_indent="- ", subsequent_indent="  "))
    return DONE
