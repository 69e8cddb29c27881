"""Results on disk: what goes in comes out, and a stranger's tools read it."""

import dataclasses
import hashlib
import json
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr

import fyke
from fyke.forces.frame import Frame
from fyke.netting.elastic import LinearLaw, PowerLaw, TableLaw
from fyke.netting.line import line
from fyke.netting.net import Net
from fyke.netting.panel import panel
from fyke.netting.twine import Twine
from fyke.results import ResultError, load, save
from fyke.results.fields import FRAME_FIELDS, NET_FIELDS
from fyke.results.layout import Content, _upper_size
from fyke.solve.outcome import Outcome
from fyke.solve.result import Result

TWINE = Twine("main", 1140.0, 0.0015, LinearLaw(1e9), damping_time=1e-4, material="PA")
OUTCOME = Outcome(
    "not_settled",
    "The net still moves at knot 3-5.",
    "Give a longer duration.",
    "verner",
    "none",
    1234,
    0,
    2.5e-3,
    0.75,
    time=2.0,
    rejected=7,
    force_evaluations=9876,
    warnings=("bar 12: strain 0.31 is above 0.3", "a second sentence\nover two lines"),
)
EXAMPLE = Path(__file__).parents[1] / "examples" / "panel.toml"
CASE = 'schema = 1\ntitle = "Flume panel, 4 °C"\n'


def make_net() -> Net:
    return panel(
        TWINE, mesh="diamond", meshes=(2, 3), bar_length=0.03, size=(0.08, 0.11), knot_diameter=0.0035
    )


def make_frame(net: Net, number: int) -> Frame:
    """Return a frame whose every value tells its place and the number of the frame."""
    n, m = net.knot_count, net.bar_count
    base = 1000.0 * number

    def ramp(*shape: int) -> np.ndarray:
        return base + np.arange(np.prod(shape), dtype=float).reshape(shape) / 7.0

    return Frame(
        time=0.1 * number,
        position=ramp(n, 3),
        velocity=-ramp(n, 3),
        tension=ramp(m),
        bar_drag=ramp(m) + 1.0,
        bar_lift=ramp(m) + 2.0,
        water_velocity=ramp(m, 3) + 2.5,
        water_force=ramp(n, 3) + 3.0,
        hydrodynamic_force=ramp(3),
        support_reaction=ramp(3) + 4.0,
        kinetic_energy=base + 0.25,
        unbalanced_force=base + 0.5,
    )


def make_result(count: int = 4) -> Result:
    net = make_net()
    return Result.from_frames(net, OUTCOME, 0.01, [make_frame(net, i) for i in range(count)], CASE)


def assert_same(one, other):
    """Compare dataclasses field by field, arrays bit by bit."""
    assert type(one) is type(other)
    for field in dataclasses.fields(one):
        a, b = getattr(one, field.name), getattr(other, field.name)
        if dataclasses.is_dataclass(a):
            assert_same(a, b)
        elif isinstance(a, tuple) and a and dataclasses.is_dataclass(a[0]):
            assert len(a) == len(b)
            for x, y in zip(a, b, strict=True):
                assert_same(x, y)
        elif isinstance(a, np.ndarray):
            assert a.dtype == b.dtype, field.name
            np.testing.assert_array_equal(a, b, err_msg=field.name)
        else:
            assert type(a) is type(b), field.name
            assert a == b, field.name


def test_the_register_names_every_variable_of_a_frame_and_a_net():
    assert [field.name for field in FRAME_FIELDS] == [f.name for f in dataclasses.fields(Frame)]
    in_attributes = {"twines", "panels", "ropes", "bodies"}
    assert set(NET_FIELDS) - {"bar_diameter"} == {f.name for f in dataclasses.fields(Net)} - in_attributes


def test_a_result_comes_back_bit_by_bit(tmp_path):
    result = make_result()
    save(result, tmp_path / "result.nc")
    assert_same(load(tmp_path / "result.nc"), result)


def test_every_elastic_law_and_many_twines_come_back(tmp_path):
    net = make_net()
    laws = (PowerLaw(345.37e6, 1.0121), TableLaw((0.0, 0.1, 0.3), (0.0, 12.5, 1 / 3)), LinearLaw(1e9))
    twines = tuple(Twine(f"t{i}", 950.0 + i, 1e-3 * (i + 1), law) for i, law in enumerate(laws))
    net = dataclasses.replace(net, twines=twines, twine_of_bar=np.arange(net.bar_count) % 3)
    result = Result.from_frames(net, OUTCOME, 0.01, [make_frame(net, 0)])
    save(result, tmp_path / "result.nc")
    assert_same(load(tmp_path / "result.nc"), result)
    diameters = xr.open_dataset(tmp_path / "result.nc", engine="h5netcdf").bar_diameter.values
    np.testing.assert_array_equal(diameters[:4], [1e-3, 2e-3, 3e-3, 1e-3])


def test_a_law_that_no_file_can_hold_is_refused_by_name(tmp_path):
    class Rubber:
        def rows(self, diameter):
            return np.zeros((1, 5))

        def describe(self):
            return ""

    net = dataclasses.replace(make_net(), twines=(Twine("main", 1140.0, 0.0015, Rubber()),))
    with pytest.raises(ValueError, match="Rubber"):
        save(Result.from_frames(net, OUTCOME, 0.0, [make_frame(net, 0)]), tmp_path / "result.nc")
    assert list(tmp_path.iterdir()) == []


def test_a_net_without_bars_is_saved(tmp_path):
    net = line(TWINE, [[0.0, 0.0, 0.0]], 1.0, fixed=())
    result = Result.from_frames(net, OUTCOME, 0.5, [make_frame(net, i) for i in range(3)])
    save(result, tmp_path / "sphere.nc")
    assert_same(load(tmp_path / "sphere.nc"), result)


def test_a_case_text_of_half_a_megabyte_is_kept(tmp_path):
    text = "# a long remark, 4 °C\n" * 25_000
    save(dataclasses.replace(make_result(), case_text=text), tmp_path / "result.nc")
    assert load(tmp_path / "result.nc").case_text == text


@pytest.mark.filterwarnings("error")
def test_xarray_finds_dimensions_units_meanings_and_provenance(tmp_path):
    result = make_result()
    save(result, tmp_path / "result.nc")
    with xr.open_dataset(tmp_path / "result.nc", engine="h5netcdf") as data:
        knots, bars = 2 * 3 * 2 + 2 + 3 + 1, 4 * 2 * 3
        assert dict(data.sizes) == {"time": 4, "knot": knots, "bar": bars, "xyz": 3, "end": 2}
        for name, variable in data.variables.items():
            assert variable.attrs["units"], name
            assert variable.attrs["long_name"], name
        assert data.position.attrs["units"] == "m"
        assert data.tension.attrs["units"] == "N"
        np.testing.assert_array_equal(data.time, result.time)
        at = data.position.set_xindex("knot_label").sel(knot_label="1-3", xyz="z").isel(time=-1)
        assert at == result.position[-1, result.net.labels.index("1-3"), 2]
        assert data.attrs["case"] == CASE
        assert data.attrs["case_sha256"] == hashlib.sha256(CASE.encode()).hexdigest()
        assert data.attrs["title"] == "Flume panel, 4 °C"
        assert data.attrs["outcome"] == "not_settled"
        assert data.attrs["outcome_residual"] == 2.5e-3
        assert data.attrs["numpy_version"] == np.__version__
        assert json.loads(data.attrs["twines"])[0]["law"] == {"kind": "linear", "youngs_modulus": 1e9}


def test_saving_replaces_the_old_file_and_leaves_nothing_beside(tmp_path):
    path = tmp_path / "result.nc"
    save(make_result(4), path)
    save(make_result(2), path)
    assert len(load(path).time) == 2
    assert [p.name for p in tmp_path.iterdir()] == ["result.nc"]


def test_a_number_that_is_not_finite_is_refused_and_the_old_file_stays(tmp_path):
    path = tmp_path / "result.nc"
    result = make_result()
    save(result, path)
    velocity = result.velocity.copy()
    velocity[2, 4, 1] = np.nan
    label = result.net.labels[4]
    with pytest.raises(ValueError, match=rf"velocity is nan.*at 0\.2 s of knot {label} along y"):
        save(dataclasses.replace(result, velocity=velocity), path)
    rest_length = result.net.rest_length.copy()
    rest_length[3] = np.inf
    with pytest.raises(ValueError, match=r"rest_length is inf.*of bar 3 \(\d-\d to \d-\d\)"):
        save(dataclasses.replace(result, net=dataclasses.replace(result.net, rest_length=rest_length)), path)
    assert_same(load(path), result)
    assert [p.name for p in tmp_path.iterdir()] == ["result.nc"]


def test_a_file_that_is_no_result_is_told_in_one_sentence(tmp_path):
    def complaint(path):
        with pytest.raises(ResultError) as caught:
            load(path)
        message = str(caught.value)
        assert message.startswith(str(path))
        assert message.endswith(".")
        assert "\n" not in message
        return message

    assert "there is no such file" in complaint(tmp_path / "missing.nc")
    text = tmp_path / "text.nc"
    text.write_text("x,y,z\n")
    assert "no netCDF-4 file" in complaint(text)
    foreign = tmp_path / "foreign.nc"
    xr.Dataset({"time": ("time", [0.0])}).to_netcdf(foreign, engine="h5netcdf")
    assert "not written by fyke" in complaint(foreign)
    newer = tmp_path / "newer.nc"
    save(make_result(), newer)
    with h5py.File(newer, "r+") as file:
        file.attrs["fyke_result_schema"] = 99
    assert "schema 99" in complaint(newer)
    poor = tmp_path / "poor.nc"
    save(make_result(), poor)
    with h5py.File(poor, "r+") as file:
        del file["tension"]
    assert "tension" in complaint(poor)


def test_a_file_cut_off_anywhere_is_told(tmp_path):
    path = tmp_path / "result.nc"
    save(make_result(), path)
    whole = path.read_bytes()
    for length in range(0, len(whole) - 1, len(whole) // 40):
        path.write_bytes(whole[:length])
        with pytest.raises(ResultError):
            load(path)


def test_a_stranger_can_check_the_balance_of_a_solved_panel(tmp_path):
    case = fyke.load_case(EXAMPLE)
    result = fyke.solve_static(fyke.build_system(fyke.build_net(case), case))
    fyke.save(result, tmp_path / "result.nc")
    assert_same(fyke.load(tmp_path / "result.nc"), result)
    with xr.open_dataset(tmp_path / "result.nc", engine="h5netcdf") as data:
        last = data.isel(time=-1)
        start, end = (last.position[last.bar_knots[:, side].values].values for side in (0, 1))
        pull = (end - start) / np.linalg.norm(end - start, axis=1)[:, None] * last.tension.values[:, None]
        held = np.zeros((data.sizes["knot"], 3))
        np.add.at(held, last.bar_knots[:, 0].values, pull)
        np.add.at(held, last.bar_knots[:, 1].values, -pull)
        free = last.fixed.values == 0
        # A free knot: tensions and water carry its weight, the same for every knot inside the panel.
        left = (held + last.water_force.values)[free]
        np.testing.assert_allclose(left[:, :2], 0.0, atol=1e-7)
        assert left[:, 2].min() > 0.0
        np.testing.assert_allclose(left[:, 2], left[:, 2].mean(), atol=1e-7)
        total = last.hydrodynamic_force.values - [0.0, 0.0, float(last.weight_in_water)]
        np.testing.assert_allclose(last.support_reaction, total, atol=1e-6)


@pytest.mark.parametrize("meshes", [(1, 1), (8, 8), (60, 40)])
def test_the_room_that_is_reserved_is_never_too_small_nor_far_too_large(tmp_path, meshes):
    net = panel(TWINE, mesh="diamond", meshes=meshes, bar_length=0.03, size=tuple(0.04 * n for n in meshes))
    system = fyke.make_system(net)
    result = fyke.solve_static(system, max_iterations=1)
    save(result, tmp_path / "result.nc")
    attributes = {"outcome": "stalled", "outcome_message": result.outcome.message}
    room = _upper_size(Content(net, 0.0, "", attributes), 1)
    size = (tmp_path / "result.nc").stat().st_size
    assert size <= room <= size + 100_000 + 0.5 * size
