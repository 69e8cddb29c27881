"""A result in a notebook: what it shows of itself, its plots in given axes, and its data set."""

from __future__ import annotations

import base64
import io
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from PIL import Image

import fyke

NOTEBOOK = Path(__file__).parents[1] / "examples" / "panel.ipynb"


@pytest.fixture(scope="module")
def result(framed) -> fyke.Result:
    return fyke.solve_static(framed(meshes=(4, 4), size=(0.15, 0.15)))


@pytest.fixture(scope="module")
def run(framed) -> fyke.Result:
    return fyke.simulate(
        framed(meshes=(3, 3), size=(0.11, 0.11)), duration=0.02, every=0.005, stepper=fyke.Symplectic()
    )


def lines(ax) -> list[np.ndarray]:
    """All straight pieces of the taut and slack bars of axes."""
    told = [
        c
        for c in ax.collections
        if isinstance(c, LineCollection) and c.get_gid() in ("taut-bars", "slack-bars")
    ]
    return [piece for c in told for piece in c.get_segments()]


def test_a_result_shows_its_numbers_and_a_picture(result):
    shown = result._repr_html_()
    assert f"{result.tension.max():.4g} N" in shown and "<td style='text-align:left'>converged" in shown
    (data,) = re.findall(r"data:image/png;base64,([^']+)'", shown)
    picture = np.asarray(Image.open(io.BytesIO(base64.b64decode(data))).convert("RGB"))
    assert picture.shape[1] > 200 and picture.std() > 5.0
    evil = replace(result, case_text='title = "<script>"')
    assert "<script>" not in evil._repr_html_() and "&lt;script&gt;" in evil._repr_html_()


def test_plots_draw_into_the_axes_that_they_are_given(result, run):
    figure = Figure(figsize=(9.0, 3.5))
    axes = figure.subplots(1, 3)
    for ax, plot in zip(axes, (result.plot.shape, result.plot.tension, run.plot.history), strict=True):
        assert plot(ax) is ax
    assert len(lines(axes[0])) == len(lines(axes[1])) == result.net.bar_count
    # The plan in the given axes is the net itself, flat: diamonds of 0.15 m over 4 meshes.
    assert np.ptp(np.concatenate(lines(axes[1])), axis=0) == pytest.approx([0.15, 0.15])
    force = run.hydrodynamic_force[:, 0]
    (curve,) = axes[2].get_lines()
    factor = 1e3 if axes[2].get_ylabel() == "Drag (mN)" else 1.0
    assert curve.get_ydata() == pytest.approx(factor * force, rel=1e-3)
    assert axes[2].get_xlabel() == "Time (s)"


@pytest.mark.parametrize("size", [(3.0, 3.0), (8.0, 3.0), (3.0, 7.0)])
def test_the_shape_stays_within_its_axes_with_one_scale(result, size):
    figure = Figure(figsize=size)
    ax = result.plot.shape(figure.add_subplot())
    figure.canvas.draw()
    pixels = ax.transData.transform(np.concatenate(lines(ax)))
    low, high = ax.get_window_extent().get_points()
    assert np.all(pixels >= low) and np.all(pixels <= high)
    corners = ax.transData.transform([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    assert corners[1, 0] - corners[0, 0] == pytest.approx(corners[2, 1] - corners[0, 1])
    (cax,) = [other for other in figure.axes if other is not ax]
    inside = cax.get_window_extent().get_points()
    assert np.all(inside[0] >= low) and np.all(inside[1] <= high)


def test_without_axes_a_plot_makes_a_figure_of_its_own(result, run):
    from matplotlib import pyplot

    pyplot.close("all")
    try:
        made = [result.plot.shape(), result.plot.tension(), run.plot.history(of="largest tension")]
        assert len(pyplot.get_fignums()) == 3
        assert made[2].get_ylabel().startswith("Largest tension (")
    finally:
        pyplot.close("all")


def test_what_there_is_none_of_is_named(result, run):
    with pytest.raises(ValueError, match="two frames"):
        result.plot.history()
    with pytest.raises(ValueError, match="centre deflection, drag, largest tension, kinetic energy"):
        run.plot.history(of="taste")
    with pytest.raises(ValueError, match="no panel 'wing'"):
        result.plot.tension(panel="wing")


def check_against(data: xarray.Dataset, file: xarray.Dataset) -> None:
    assert set(data.variables) == set(file.variables) and set(data.coords) == {"time", "knot_label", "xyz"}
    for name, variable in file.variables.items():
        assert data[name].dims == variable.dims and np.array_equal(data[name].values, variable.values), name
        assert data[name].attrs["units"] == file[name].attrs.get("units", data[name].attrs["units"])
        assert data[name].attrs["long_name"] == variable.attrs["long_name"]


def test_the_data_set_is_what_xarray_reads_from_the_file(run, tmp_path):
    fyke.save(run, tmp_path / "run.nc")
    with xarray.open_dataset(tmp_path / "run.nc", engine="h5netcdf", decode_times=False) as file:
        check_against(run.to_xarray(), file)
        told = run.to_xarray().attrs
        assert {key: file.attrs[key] for key in ("case", "twines", "panels", "outcome")} == {
            key: told[key] for key in ("case", "twines", "panels", "outcome")
        }
    pull = run.to_xarray().tension
    assert pull.attrs["units"] == "N" and float(pull.isel(time=-1).max()) == run.tension[-1].max()


def test_the_data_set_can_be_written_by_xarray_and_read_again(run, tmp_path):
    run.to_xarray().to_netcdf(tmp_path / "again.nc", engine="h5netcdf")
    with xarray.open_dataset(tmp_path / "again.nc", decode_times=False) as file:
        assert np.array_equal(file.position, run.position)


def test_the_library_of_netcdf_itself_reads_a_result(run, tmp_path):
    netcdf = pytest.importorskip("netCDF4", reason="netCDF4 reads the file too: pip install 'fyke[notebook]'")
    fyke.save(run, tmp_path / "run.nc")
    with netcdf.Dataset(tmp_path / "run.nc") as file:
        assert np.array_equal(file["tension"][:], run.tension) and file["tension"].units == "N"
        assert tuple(file["knot_label"][:]) == run.net.labels
        assert file["position"].dimensions == ("time", "knot", "xyz")


def test_the_example_notebook_runs():
    why = "nbformat, nbclient and ipykernel run it: pip install 'fyke[notebook]'"
    nbformat, nbclient = (pytest.importorskip(name, reason=why) for name in ("nbformat", "nbclient"))
    pytest.importorskip("ipykernel", reason=why)
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    nbformat.validate(notebook)
    assert not any(cell.get("outputs") for cell in notebook.cells)  # kept clean
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3").execute()
    told = "".join(str(cell.get("outputs", "")) for cell in notebook.cells)
    assert told.count("image/png") >= 3 and "converged" in told and "most carried off: knot" in told
