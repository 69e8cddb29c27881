"""Exports: what the programs they are made for read out of them."""

from __future__ import annotations

import csv
import json
import struct
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from typer.testing import CliRunner

import fyke
from fyke.cli.app import app
from fyke.forces.frame import Frame
from fyke.report import gltf
from fyke.report.colours import QuantityError, linear
from fyke.report.gltf import write_gltf
from fyke.report.solids import SIDES, balls, tubes
from fyke.results.export import write_csv, write_vtkhdf, write_vtu
from fyke.results.whole import replacing_folder

CASE = Path(__file__).parents[1] / "examples" / "panel_release.toml"
STEPS = 5


def made(frames: int) -> fyke.Result:
    """A panel in motion with numbers that have all their digits, every frame another."""
    case = fyke.load_case(CASE)
    net = fyke.build_net(case)
    random = np.random.default_rng(7)
    n, m = net.knot_count, net.bar_count
    told = []
    for k in range(frames):
        at, speed, force = (random.normal(size=(n, 3)) for _ in range(3))
        pull = np.maximum(random.normal(size=m), 0.0)
        flow, whole = random.normal(size=(m, 3)), force.sum(axis=0)
        told.append(
            Frame(k / 7.0, at, speed, pull, pull / 3.0, pull / 7.0, flow, force, whole, -whole, k / 3.0, 0.1)
        )
    outcome = fyke.Outcome("completed", "", "", "by hand", "", frames, 0, 0.1, 0.0, time=(frames - 1) / 7.0)
    return fyke.Result.from_frames(net, outcome, 0.25, told, case.text)


@pytest.fixture(scope="module")
def result() -> fyke.Result:
    return made(STEPS)


@pytest.fixture
def vtk():
    """The readers of VTK, without the rest of it."""
    why = "VTK's own readers need vtk: pip install 'fyke[vtk]'"
    names = ("vtkIOHDF", "vtkIOXML", "vtkCommonExecutionModel", "util.numpy_support")
    hdf, xml, pipeline, _ = (pytest.importorskip(f"vtkmodules.{name}", reason=why) for name in names)
    return SimpleNamespace(hdf=hdf.vtkHDFReader, xml=xml.vtkXMLUnstructuredGridReader, pipeline=pipeline)


def arrays(data) -> dict[str, np.ndarray]:
    """All numbers of a point, cell or field data object of VTK."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    found = (data.GetArray(k) for k in range(data.GetNumberOfArrays()))
    return {one.GetName(): vtk_to_numpy(one).copy() for one in found if one is not None}


def check_grid(grid, result: fyke.Result, k: int) -> None:
    """Everything in a grid of VTK is what the result has in frame k, to the bit and in float64."""
    net = result.net
    points, bars, whole = (arrays(d) for d in (grid.GetPointData(), grid.GetCellData(), grid.GetFieldData()))
    from vtkmodules.util.numpy_support import vtk_to_numpy

    at = vtk_to_numpy(grid.GetPoints().GetData())
    assert at.dtype == np.float64 and np.array_equal(at, result.position[k])
    for name in ("velocity", "water_force"):
        assert np.array_equal(points[name], getattr(result, name)[k]), name
    for name in ("tension", "bar_drag", "bar_lift"):
        assert bars[name].dtype == np.float64 and np.array_equal(bars[name], getattr(result, name)[k]), name
    assert np.array_equal(points["fixed"], net.fixed) and np.array_equal(
        points["knot"], range(net.knot_count)
    )
    ends = [[grid.GetCell(b).GetPointId(e) for e in (0, 1)] for b in range(net.bar_count)]
    assert np.array_equal(ends, net.bars) and grid.GetCell(0).GetClassName() == "vtkLine"
    a, b = result.position[k][net.bars[:, 0]], result.position[k][net.bars[:, 1]]
    assert bars["strain"] == pytest.approx(np.linalg.norm(b - a, axis=1) / net.rest_length - 1.0, rel=1e-12)
    assert np.array_equal(whole["hydrodynamic_force"].ravel(), result.hydrodynamic_force[k])
    labels = grid.GetFieldData().GetAbstractArray("knot_label")
    assert tuple(labels.GetValue(i) for i in range(labels.GetNumberOfValues())) == net.labels


@pytest.mark.parametrize("frames", [1, STEPS])
def test_vtk_reads_every_step_of_a_vtkhdf_file_to_the_bit(frames, vtk, tmp_path):
    result = made(frames)
    reader = vtk.hdf()
    reader.SetFileName(str(write_vtkhdf(result, tmp_path / "net.vtkhdf")))
    reader.UpdateInformation()
    key = vtk.pipeline.vtkStreamingDemandDrivenPipeline.TIME_STEPS()
    # The reader tells no times of a single step.
    times = reader.GetOutputInformation(0).Get(key) or (0.0,)
    assert np.array_equal(times, result.time) and reader.GetNumberOfSteps() == frames
    for k in (frames - 1, 0, frames // 2):  # forth and back
        reader.UpdateTimeStep(times[k])
        check_grid(reader.GetOutput(), result, k)


def test_what_does_not_move_is_in_a_vtkhdf_file_once(result, tmp_path):
    import h5py

    with h5py.File(write_vtkhdf(result, tmp_path / "net.vtkhdf")) as file:
        root = file["VTKHDF"]
        n, m = result.net.knot_count, result.net.bar_count
        assert root["Points"].shape == (STEPS * n, 3) and root["Connectivity"].shape == (2 * m,)
        assert root["PointData/initial_position"].shape == (n, 3) and root["CellData/rest_length"].shape == (
            m,
        )
        assert root["CellData/tension"].shape == (STEPS * m,)
        assert root["CellData/tension"].attrs["units"] == "N"


def test_vtk_reads_every_file_of_a_vtu_series_to_the_bit(result, vtk, tmp_path):
    from xml.etree import ElementTree

    folder = write_vtu(result, tmp_path / "net_vtu")
    frames = list(ElementTree.parse(folder / "frames.pvd").iter("DataSet"))
    assert [float(one.get("timestep")) for one in frames] == result.time.tolist()
    for k, one in enumerate(frames):
        check_grid(read_vtu(vtk, folder / one.get("file")), result, k)


def read_vtu(vtk, path: Path):
    reader = vtk.xml()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def test_a_static_result_is_one_vtu_file(vtk, tmp_path):
    result = made(1)
    file = write_vtu(result, tmp_path / "net.vtu")
    assert file.is_file() and len(list(tmp_path.iterdir())) == 1
    check_grid(read_vtu(vtk, file), result, 0)


def test_tables_have_a_row_for_every_knot_and_bar_and_moment(result, tmp_path):
    folder = write_csv(result, tmp_path / "tables")
    read = {}
    for name in ("knots", "bars", "histories"):
        with (folder / f"{name}.csv").open(newline="") as file:
            read[name] = list(csv.DictReader(file))
    net = result.net
    n, m = net.knot_count, net.bar_count
    assert [len(read[name]) for name in ("knots", "bars", "histories")] == [STEPS * n, STEPS * m, STEPS]
    places = [[float(row[axis]) for axis in "xyz"] for row in read["knots"]]
    assert np.array_equal(places, result.position.reshape(-1, 3))
    assert [row["knot_label"] for row in read["knots"]] == list(net.labels) * STEPS
    assert np.array_equal([float(row["tension"]) for row in read["bars"]], result.tension.ravel())
    assert np.array_equal([float(row["time"]) for row in read["bars"]], np.repeat(result.time, m))
    assert np.array_equal([int(row["knot_b"]) for row in read["bars"][-m:]], net.bars[:, 1])
    assert [float(row["support_reaction_z"]) for row in read["histories"]] == result.support_reaction[
        :, 2
    ].tolist()
    described = json.loads((folder / "columns.json").read_text())
    for name, rows in read.items():
        assert list(described[f"{name}.csv"]) == list(rows[0])
    assert described["knots.csv"]["vx"]["units"] == "m s-1"


def test_blender_gets_tubes_of_true_size_with_z_turned_up(result, tmp_path):
    trimesh = pytest.importorskip("trimesh", reason="trimesh reads the file back: pip install trimesh")
    scene = trimesh.load(write_gltf(result, tmp_path / "net.glb"))
    netting = scene.geometry["netting"]
    net, last = result.net, result.position[-1]
    middles = np.asarray(netting.vertices).reshape(net.bar_count, 2, SIDES, 3).mean(axis=2)
    turned = last[:, [0, 2, 1]] * [1.0, 1.0, -1.0]  # x, z, -y
    assert middles == pytest.approx(turned[net.bars], abs=1e-6)
    away = np.linalg.norm(
        np.asarray(netting.vertices).reshape(-1, SIDES, 3) - middles.reshape(-1, 1, 3), axis=2
    )
    assert away == pytest.approx(0.5 * 1.5e-3, rel=2e-3)  # twine of 1.5 mm
    assert len(scene.geometry["knot"].vertices) == 12 * net.knot_count
    # The slack are grey, sRGB 8C8C8C; 0.2623 in linear light.
    colours = np.asarray(netting.visual.vertex_attributes["color"], dtype=float)[:: 2 * SIDES, :3]
    colours /= 65535.0 if colours.max() > 1.0 else 1.0
    grey = np.all(np.abs(colours - 0.2623) < 1e-3, axis=1)
    assert np.array_equal(grey, result.tension[-1] == 0.0)


def test_a_net_too_large_for_tubes_goes_out_as_lines(result, tmp_path, monkeypatch):
    monkeypatch.setattr(gltf, "TUBES_UP_TO", 255)
    data = write_gltf(result, tmp_path / "net.glb").read_bytes()
    magic, version, size, length, _ = struct.unpack("<4sIIII", data[:20])
    assert (magic, version, size) == (b"glTF", 2, len(data))
    told, binary = json.loads(data[20 : 20 + length]), data[28 + length :]
    (netting,) = (mesh["primitives"][0] for mesh in told["meshes"] if mesh["name"] == "netting")
    assert netting["mode"] == 1  # LINES in the specification of glTF

    def array(number: int, kind: str) -> np.ndarray:
        view = told["bufferViews"][told["accessors"][number]["bufferView"]]
        return np.frombuffer(binary[view["byteOffset"] :][: view["byteLength"]], kind)

    points = array(netting["attributes"]["POSITION"], "<f4").reshape(-1, 3)
    ends = points[array(netting["indices"], "<u4").reshape(-1, 2)]
    turned = result.position[-1][:, [0, 2, 1]] * [1.0, 1.0, -1.0]
    assert ends == pytest.approx(turned[result.net.bars], abs=1e-6)


def test_solids_are_those_of_geometry():
    # Linear light of half grey, IEC 61966-2-1; volume of an icosahedron of circumradius 1.
    assert linear([0.5, 0.02]) == pytest.approx([0.21404, 0.02 / 12.92], rel=1e-4)
    ball = balls(np.array([[1.0, 2.0, 3.0]]), np.array([2.0]), np.zeros((1, 3)))
    corner = ball.points[ball.corners] - [1.0, 2.0, 3.0]
    assert np.linalg.det(corner).sum() / 6.0 == pytest.approx(8.0 * 2.53615, rel=1e-5)
    tube = tubes(np.zeros((1, 3)), np.array([[0.0, 0.0, 5.0]]), np.array([0.5]), np.zeros((1, 3)))
    a, b, c = tube.points[tube.corners].transpose(1, 0, 2)
    across = np.cross(b - a, c - a)
    # Six sides of length 5, each as wide as the radius, all facing out.
    assert np.linalg.norm(across, axis=1).sum() / 2.0 == pytest.approx(6 * 5.0 * 0.5)
    assert np.all(np.einsum("tq,tq->t", across, tube.normals[tube.corners[:, 0]]) > 0.0)


def test_a_colour_that_is_not_there_is_named(result, tmp_path):
    with pytest.raises(QuantityError, match="choose tension, strain"):
        write_gltf(result, tmp_path / "net.glb", colour="taste")
    still = replace(result, velocity=0.0 * result.velocity, water_velocity=0.0 * result.water_velocity)
    with pytest.raises(QuantityError, match="no water passes"):
        write_gltf(still, tmp_path / "net.glb", colour="angle")
    assert not list(tmp_path.iterdir())


def test_a_net_without_bars_goes_out_too(result, vtk, tmp_path):
    net = result.net
    bare = replace(net, bars=net.bars[:0], rest_length=net.rest_length[:0], twine_of_bar=net.twine_of_bar[:0])
    empty = {
        name: getattr(result, name)[:, :0] for name in ("tension", "bar_drag", "bar_lift", "water_velocity")
    }
    lone = replace(result, net=replace(bare, panels=()), **empty)
    for write in (write_vtkhdf, write_vtu, write_csv, write_gltf):
        assert write(lone, tmp_path / write.__name__).exists()
    assert read_vtu(vtk, tmp_path / "write_vtu" / "frame_0.vtu").GetNumberOfPoints() == net.knot_count


def test_a_folder_is_replaced_whole_and_never_that_of_others(tmp_path):
    target = tmp_path / "there"
    for text in ("old", "new"):
        with replacing_folder(target, ("*.vtu",)) as folder:
            (folder / f"{text}.vtu").write_text(text)
    assert [one.name for one in target.iterdir()] == ["new.vtu"]
    with pytest.raises(RuntimeError), replacing_folder(target, ("*.vtu",)):
        raise RuntimeError
    (target / "thesis.doc").write_text("years")
    with pytest.raises(FileExistsError, match=r"thesis\.doc"), replacing_folder(target, ("*.vtu",)):
        raise AssertionError("nothing may be written")
    assert {one.name for one in target.iterdir()} == {"new.vtu", "thesis.doc"}
    assert [one.name for one in tmp_path.iterdir()] == ["there"]


@pytest.fixture
def run(result, tmp_path, monkeypatch) -> Path:
    """The folder of a run, in the current folder."""
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "run"
    folder.mkdir()
    fyke.save(result, folder / "result.nc")
    return folder


def call(*words: object):
    return CliRunner().invoke(app, ["export", *map(str, words)])


@pytest.mark.parametrize(
    ("to", "name"), [("vtkhdf", ".vtkhdf"), ("vtu", "_vtu"), ("csv", "_csv"), ("gltf", ".glb")]
)
def test_the_command_writes_beside_the_result_and_asks_before_it_replaces(run, to, name):
    done = call(run, "--to", to)
    assert done.exit_code == 0, done.output
    target = run / f"result{name}"
    assert target.exists() and f"{STEPS} frames" in done.stdout
    again = call(run / "result.nc", "--to", to)
    assert again.exit_code == 2 and "--overwrite" in again.stderr
    assert call(run, "--to", to, "--overwrite").exit_code == 0
    assert {one.name for one in run.iterdir()} == {"result.nc", target.name}


def test_what_is_wrong_is_told_in_place_of_a_traceback(run, result):
    unknown = call(run, "--to", "obj")
    assert unknown.exit_code == 2 and "vtkhdf, vtu, csv, gltf" in unknown.stderr
    (run / "notes.nc").write_text("no result")
    own = call(run, "--to", "csv", "--overwrite", "-o", run)
    assert own.exit_code == 2 and fyke.load(run / "result.nc").time.shape == (STEPS,)
    for bad, said in (("notes.nc", "no netCDF-4"), ("none.nc", "no such file")):
        asked = call(run / bad, "--to", "csv")
        assert asked.exit_code == 2 and said in asked.stderr and "Traceback" not in asked.output
    (run / "cut.nc").write_bytes((run / "result.nc").read_bytes()[:20_000])
    cut = call(run / "cut.nc", "--to", "vtkhdf")
    assert cut.exit_code == 2 and "cut off" in cut.stderr and not (run / "cut.vtkhdf").exists()


def test_a_run_that_was_killed_is_exported_as_far_as_it_came_and_that_is_said(run, result):
    from fyke.results import Recorder

    with Recorder("half.nc", result.net, times=STEPS, weight_in_water=0.25) as recorder:
        for k in range(3):
            recorder.append(result.frame(k))
    done = call("half.nc", "--to", "csv")
    assert done.exit_code == 0 and "up to 0.285714 s" in done.stdout and "3 frames" in done.stdout


def test_a_newer_result_asks_for_a_newer_fyke(run):
    import h5py

    with h5py.File(run / "result.nc", "r+") as file:
        file.attrs["fyke_result_schema"] = 99
    done = call(run, "--to", "vtu")
    assert done.exit_code == 2 and "update fyke" in done.stderr


@pytest.mark.parametrize("to", ["vtkhdf", "vtu", "csv", "gltf"])
def test_a_full_disk_is_told_and_leaves_nothing_behind(to, run):
    resource = pytest.importorskip("resource", reason="this system has no limit on the size of a file")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, before[1]))
    try:
        done = call(run, "--to", to)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert done.exit_code == 2 and "File too large" in done.stderr and "cure" in done.stderr
    assert [one.name for one in run.iterdir()] == ["result.nc"]
