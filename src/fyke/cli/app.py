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
ResultPath = Annotated[
    Path, typer.Argument(metavar="RESULT", show_default=False, help="result.nc or the folder of a run.")
]


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
    *,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Folder to write to; CASE's name by default."),
    ] = None,
    figures: Annotated[bool, typer.Option("--figures/--no-figures", help="Draw the figures.")] = True,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace a result that is there.")] = False,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with a dynamic run that was stopped.")
    ] = False,
    uncertainty: Annotated[
        Path | None,
        typer.Option(
            "--uncertainty", metavar="STUDY.toml", help="Solve it for samples of uncertain inputs instead."
        ),
    ] = None,
    jobs: Annotated[
        int, typer.Option("-j", "--jobs", metavar="N", min=1, help="Processes of a study of uncertainty.")
    ] = 2,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")] = False,
    json: Annotated[bool, typer.Option("--json", help="Print summary.json and nothing else.")] = False,
) -> None:
    """Solve a case and write its result, tables and figures."""
    began = time.perf_counter()
    from .load_cases import Wishes
    from .run import run_case

    wishes = Wishes(
        output=output, figures=figures, overwrite=overwrite, resume=resume, quiet=quiet, json=json
    )
    if uncertainty is not None:
        from .uncertainty import run_study

        raise typer.Exit(run_study(case, uncertainty, wishes, jobs=jobs))
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


laws = typer.Typer(help="List the drag laws, each with its range, area and source; plot draws them.")
app.add_typer(laws, name="laws")


@laws.callback(invoke_without_command=True)
def _laws(
    context: typer.Context,
    json: Annotated[bool, typer.Option("--json", help="Print JSON and nothing else.")] = False,
) -> None:
    if context.invoked_subcommand is None:
        from .laws import list_laws

        raise typer.Exit(list_laws(json=json))


@laws.command("plot")
def plot_of_laws(
    names: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="NAMES", show_default=False, help="Laws, or CSV tables of your own; all laws."
        ),
    ] = None,
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="FILE", help="Picture, as .png and .svg.")
    ] = Path("laws.png"),
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace pictures that are there.")] = False,
) -> None:
    """Draw drag laws over measured points."""
    from .laws import plot_laws

    raise typer.Exit(plot_laws(names or [], output, overwrite=overwrite))


@app.command()
def report(
    result: ResultPath,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE", help="Page to write; report.html beside the result."),
    ] = None,
    positions: Annotated[
        Path | None, typer.Option("--positions", metavar="CSV", help="Measured positions to compare with.")
    ] = None,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace a page that is there.")] = False,
) -> None:
    """Write one HTML page of a result, to hand over."""
    from .report import report_result

    raise typer.Exit(report_result(result, output, positions, overwrite=overwrite))


@app.command()
def validate(
    folder: Annotated[Path, typer.Argument(metavar="FOLDER", help="Folder of claims.")] = Path("validation"),
    only: Annotated[
        list[str] | None, typer.Option("--only", metavar="NAME", help="This claim alone; may be repeated.")
    ] = None,
    fast: Annotated[bool, typer.Option("--fast", help="Leave out the claims that take long.")] = False,
    jobs: Annotated[int, typer.Option("-j", "--jobs", metavar="N", min=1, help="Claims at a time.")] = 2,
    write: Annotated[
        bool,
        typer.Option(
            "--write/--no-write", help="Write report.html, and REPORT.md of the whole set, into FOLDER."
        ),
    ] = True,
    every: Annotated[
        bool, typer.Option("--all", help="Print every row, not the worst of those alike.")
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print JSON and nothing else.")] = False,
) -> None:
    """Check fyke against exact solutions, other programs and experiments, one table."""
    from .validate import Wishes, validate_folder

    wishes = Wishes(only=tuple(only or ()), fast=fast, jobs=jobs, every=every, json=json, write=write)
    raise typer.Exit(validate_folder(folder, wishes))


@app.command()
def live(
    case: CaseFile,
    port: Annotated[int, typer.Option("--port", min=1, max=65535, help="Port, or the next free one.")] = 8080,
    host: Annotated[str, typer.Option("--host", help="Address to serve on.")] = "127.0.0.1",
    open_to_network: Annotated[
        bool, typer.Option("--open-to-network", help="Allow a host that other machines reach.")
    ] = False,
) -> None:
    """Open a case in the browser and play with it: sliders, motion, knots to drag."""
    from .live import run_live

    raise typer.Exit(run_live(case, host=host, port=port, open_to_network=open_to_network))


@app.command()
def export(
    result: ResultPath,
    to: Annotated[str, typer.Option("--to", metavar="FORMAT", help="vtkhdf, vtu, csv or gltf.")],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="PATH", help="What to write; a name beside the result."),
    ] = None,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace what is there.")] = False,
) -> None:
    """Write a result in the files of other programs."""
    from .export import export_result

    raise typer.Exit(export_result(result, to, output, overwrite=overwrite))


@app.command()
def movie(
    result: ResultPath,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE", help="film.mp4 or .gif; movie.mp4 beside the result."),
    ] = None,
    fps: Annotated[float, typer.Option("--fps", help="Pictures a second.")] = 25.0,
    speed: Annotated[float, typer.Option("--speed", help="Of the film, 1 in real time.")] = 1.0,
    size: Annotated[str, typer.Option("--size", metavar="WxH", help="Width and height.")] = "1280x720",
    colour: Annotated[str, typer.Option("--colour", help="What bars are coloured by.")] = "tension",
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace a film that is there.")] = False,
) -> None:
    """Make a film of a dynamic run."""
    from .movie import Film, film_result

    film = Film(output=output, fps=fps, speed=speed, size=size, colour=colour, overwrite=overwrite)
    raise typer.Exit(film_result(result, film))


def main() -> None:
    """Run the command line."""
    app(prog_name="fyke")
