"""The commands and their options; what they do is imported when they run, so that `fyke --help` is quick."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer

from ..version import __version__

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
    help="Simulate fishing and aquaculture netting in water.",
    epilog="Exit codes: 0 done, 1 the solver did not converge, 2 the input is wrong.",
)

CaseFile = Annotated[Path, typer.Argument(metavar="CASE.toml", show_default=False, help="The case file.")]


def _version(asked: bool) -> None:
    if asked:
        typer.echo(f"fyke {__version__}")
        raise typer.Exit


@app.callback()
def _fyke(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version and exit.")
    ] = False,
) -> None:
    """Take the options that come before any command."""


@app.command()
def run(
    case: CaseFile,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Folder to write to; CASE's name by default."),
    ] = None,
    figures: Annotated[bool, typer.Option("--figures/--no-figures", help="Draw the figures.")] = True,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace a result that is there.")] = False,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with a dynamic run that was stopped.")
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")] = False,
    json: Annotated[bool, typer.Option("--json", help="Print summary.json and nothing else.")] = False,
) -> None:
    """Solve a case and write its result, tables and figures."""
    began = time.perf_counter()
    from .run import Wishes, run_case

    wishes = Wishes(
        output=output, figures=figures, overwrite=overwrite, resume=resume, quiet=quiet, json=json
    )
    raise typer.Exit(run_case(case, wishes, began))


@app.command()
def modes(
    case: CaseFile,
    count: Annotated[int, typer.Option("-n", "--count", metavar="N", min=1, help="How many modes.")] = 6,
    json: Annotated[bool, typer.Option("--json", help="Print JSON and nothing else.")] = False,
) -> None:
    """Find the static equilibrium and the slowest natural periods about it."""
    from .modes import show_modes

    raise typer.Exit(show_modes(case, count, json=json))


@app.command()
def check(
    case: CaseFile,
    json: Annotated[bool, typer.Option("--json", help="Print JSON and nothing else.")] = False,
) -> None:
    """Read and judge a case without solving it."""
    from .check import check_case

    raise typer.Exit(check_case(case, json=json))


@app.command()
def new(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="The file to write.")] = Path("case.toml"),
) -> None:
    """Write a commented case file to start from; never over a file that is there."""
    from .texts import write_template

    raise typer.Exit(write_template(file))


@app.command()
def schema() -> None:
    """Print the JSON Schema of the case file, for editors that complete and check while typing."""
    from .texts import print_schema

    print_schema()


@app.command()
def cite(case: CaseFile) -> None:
    """Print the sources behind the laws and methods that a case uses."""
    from .texts import print_sources

    raise typer.Exit(print_sources(case))


def main() -> None:
    """Run the command line."""
    app(prog_name="fyke")
