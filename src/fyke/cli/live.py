"""fyke live: the net in a browser."""

from __future__ import annotations

import threading
from importlib.util import find_spec
from pathlib import Path

from ..case import CaseError, Problem, load_case
from .show import DONE, NOT_CONVERGED, WRONG_INPUT, print_problems, stderr, stdout

NEEDS = ("viser", "tomli_w")


def run_live(file: Path, *, host: str, port: int, open_to_network: bool) -> int:
    """Serve a case until Ctrl-C and return the exit code."""
    missing = [name for name in NEEDS if find_spec(name) is None]
    if missing:
        cure = "install it: pip install 'fyke[view]'"
        print_problems([Problem("fyke live", f"no {' and '.join(missing)}", "the extra 'view'", cure)])
        return WRONG_INPUT
    try:
        case = load_case(file)
    except CaseError as error:
        print_problems(error.problems)
        return WRONG_INPUT
    from ..live import AddressError, RefusedError, serve

    try:
        live = serve(case.text, file, host=host, port=port, open_to_network=open_to_network)
    except AddressError as error:
        print_problems([Problem("fyke live", error.found, error.allowed, error.cure)])
        return WRONG_INPUT
    except RefusedError as error:
        stderr().print(str(error), soft_wrap=True)
        return NOT_CONVERGED
    console = stdout()
    if live.port != port:
        console.print(f"Port {port} is in use; {live.port} is the next free one.")
    if open_to_network:
        console.print("Warning: every machine that reaches this one can open the page and use its processor.")
    console.print(f"Open {live.url} in a browser. Ctrl-C ends it.", soft_wrap=True)
    try:
        threading.Event().wait()
    except KeyboardInterrupt:
        console.print("Ended.")
    finally:
        live.stop()
    return DONE
