"""Scenes: read, changed, drawn, explained, compared."""

from __future__ import annotations

import json
import os
import pickle
import subprocess
import sys
import zlib
from pathlib import Path

import numpy as np
import pytest

import lights_camera_models as lcm
from interrupt import seconds_to_end

SCENES = Path(__file__).parents[2] / "scenes"
SIZE = (64, 36)


def decoded(png: bytes) -> np.ndarray:
    """A PNG picture of 8-bit RGB, without interlacing."""
    at, data, width, height = 8, b"", 0, 0
    while at < len(png):
        length, kind = int.from_bytes(png[at : at + 4], "big"), png[at + 4 : at + 8]
        body = png[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            width, height = int.from_bytes(body[:4], "big"), int.from_bytes(body[4:8], "big")
        data += body if kind == b"IDAT" else b""
        at += length + 12
    lines = np.frombuffer(zlib.decompress(data), np.uint8).reshape(height, 1 + 3 * width)
    out = np.zeros((height, 3 * width), np.uint8)
    for y in range(height):
        line, above = lines[y, 1:].astype(int), out[y - 1].astype(int) if y else np.zeros(3 * width, int)
        for x in range(3 * width):
            a = int(out[y, x - 3]) if x >= 3 else 0
            b, c = above[x], above[x - 3] if x >= 3 else 0
            p = a + b - c
            near = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            out[y, x] = (line[x] + [0, a, b, (a + b) // 2, near][lines[y, 0]]) % 256
    return out.reshape(height, width, 3)


def test_the_picture_is_that_of_the_command(tmp_path):
    program = os.environ.get("LCM")
    if not program:
        pytest.skip("LCM does not name the program lcm; scripts/wheel sets it")
    for name in ["default", "compare_phong_blinn_phong", "glass_thin_and_solid"]:
        file = tmp_path / "a.png"
        path = SCENES / f"{name}.json"
        arguments = ["render", path, "--renderer", "cpu", "--view", "A", "--size", "64x36", "-o", file]
        subprocess.run([program, *arguments], check=True, capture_output=True)
        ours = lcm.Scene.from_json(path).render(SIZE)
        np.testing.assert_array_equal(ours, decoded(file.read_bytes()), err_msg=name)


def test_pictures_have_the_shapes_of_arrays():
    scene = lcm.Scene.new()
    codes = scene.render(SIZE)
    assert codes.shape == (36, 64, 3) and codes.dtype == np.uint8 and codes.max() > 50
    light = scene.render(SIZE, linear=True)
    assert light.shape == (36, 64, 3) and light.dtype == np.float32 and light.flags.c_contiguous
    whole = scene.render(SIZE, linear=True, coverage=True)
    assert whole.shape == (36, 64, 4) and set(np.unique(whole[..., 3])) >= {0.0, 1.0}
    np.testing.assert_array_equal(whole[..., :3], light)
    assert scene.render(SIZE, channel="normals").any()
    diffuse = scene.render(SIZE, terms="diffuse", linear=True)
    np.testing.assert_allclose(diffuse, light, atol=1e-6, err_msg="Lambert's law has no other term")
    np.testing.assert_array_equal(decoded(scene._repr_png_()), scene.render())
    np.testing.assert_array_equal(decoded(lcm.png(codes)), codes)


def test_light_with_extent_converges():
    scene = lcm.Scene.from_json(SCENES / "softbox_and_lamps.json")
    coarse, fine = (scene.render(SIZE, 1, linear=True, light_samples=n) for n in (16, 256))
    assert 0 < np.abs(coarse - fine).mean() < 0.2 * fine.mean()


def test_scenes_come_and_go_as_text_and_dictionaries():
    scene = lcm.Scene.from_json(SCENES / "compare_phong_blinn_phong.json")
    assert scene.views == 2
    assert lcm.Scene.from_dict(scene.to_dict()) == scene
    assert lcm.Scene.from_json(scene.to_json(indent=2)) == scene
    assert pickle.loads(pickle.dumps(scene)) == scene
    assert scene["lights[0].intensity"] == scene.to_dict()["lights"][0]["intensity"]
    assert not np.array_equal(scene.render(SIZE, view="A"), scene.render(SIZE, view="B"))
    assert "view" in repr(scene)


def test_values_are_set_by_path():
    scene = lcm.Scene.new()
    other = scene.set({"objects[0].material.base_colour": [255, 0, 0], "objects[0].size": 1.5}, reflection_model="phong")
    assert other["reflection_model"] == "phong" and other["objects[0].material.base_colour"] == [255, 0, 0]
    assert scene["reflection_model"] == "lambert", "scenes do not change"
    assert other.set({"objects[0].material.k_s": np.float32(0.25)})["objects[0].material.k_s"] == 0.25
    for values, text in [
        ({"objects[0].material.k_t": 1}, "objects"),
        ({"objects[9].size": 1}, "objects"),
        ({"objects[0].size": -1}, "size"),
        ({"objects[0].size": "large"}, "size"),
        ({"objects[0].size": float("nan")}, "nan"),
        ({"objects[0].size": "2"}, "must be a number"),
        ({"name": None}, "must be a word"),
        ({"objects[0].size": -1, "objects[0].material.k_t": 2}, "k_t"),
        ({"reflection_model": "fong"}, "did you mean"),
        ({"objects[0": 1}, "character"),
    ]:
        with pytest.raises(lcm.SceneError, match=text):
            scene.set(values)
    wrong = {"objects[0].size": "large", "objects[0].material.k_t": 2}
    with pytest.raises(lcm.SceneError) as raised:
        scene.set(wrong)
    assert [problem["path"] for problem in raised.value.problems] == list(wrong)
    assert all(problem["message"] for problem in raised.value.problems)


def test_every_problem_of_a_scene_is_named():
    wrong = lcm.Scene.new().to_dict()
    wrong["reflection_model"] = "fong"
    wrong["objects"][0]["size"] = -1
    wrong["colour"] = 1
    text = json.dumps(wrong, indent=1)
    with pytest.raises(lcm.SceneError) as raised:
        lcm.Scene.from_json(text)
    problems = {problem["path"]: problem for problem in raised.value.problems}
    assert set(problems) == {"reflection_model", "objects[0].size", "colour"}
    line = 1 + text[: text.index('"fong"')].count("\n")
    assert problems["reflection_model"]["line"] == line
    assert "did you mean" in str(raised.value)
    assert len(pickle.loads(pickle.dumps(raised.value)).problems) == 3


@pytest.mark.parametrize("source, error, text", [
    ("{", lcm.SceneError, "not JSON"),
    ("{}", lcm.SceneError, "missing"),
    ("no_such_file.json", OSError, "No such file"),
    ("{" * 100_000, lcm.SceneError, "JSON"),
    ('{"lights": 1}', lcm.SceneError, "lights"),
])
def test_what_is_no_scene_is_refused(source, error, text):
    with pytest.raises(error, match=text):
        lcm.Scene.from_json(source)


def test_files_outside_the_folder_of_a_scene_are_refused(tmp_path):
    scene = lcm.Scene.new().to_dict()
    scene["objects"] = [{"type": "mesh", "path": "../../../etc/passwd", "position": [5, 5, 5], "size": 1}]
    file = tmp_path / "scene.json"
    file.write_text(json.dumps(scene))
    with pytest.raises(lcm.SceneError, match="outside"):
        lcm.Scene.from_json(file)
    file.write_bytes(b"\xff\xfe{}")
    with pytest.raises(lcm.SceneError, match="UTF-8"):
        lcm.Scene.from_json(file)


@pytest.mark.parametrize("arguments, text", [
    ({"size": (0, 10)}, "the width is 0"),
    ({"size": "99"}, "width, height"),
    ({"size": (64.9, 36)}, "the width is 64.9"),
    ({"size": (64, float("inf"))}, "the height is inf"),
    ({"samples": True}, "samples is True"),
    ({"noise": "x"}, "noise is"),
    ({"size": (10**6, 10)}, "from 1 to 16384"),
    ({"size": 10}, "width, height"),
    ({"samples": 3}, "must be 1 or 4"),
    ({"view": "B"}, "there is no view"),
    ({"terms": "difuse"}, "did you mean"),
    ({"channel": "normalz"}, "channel is"),
    ({"light_samples": 0}, "whole number from 1"),
    ({"light_samples": 2.5}, "whole number from 1"),
    ({"noise": -1}, "noise is"),
    ({"coverage": True}, "linear=True"),
    ({"channel": "normals", "linear": True}, "omit linear"),
])
def test_wrong_wishes_for_pictures_are_refused(arguments, text):
    with pytest.raises((ValueError, TypeError), match=text):
        lcm.Scene.new().render(**{"size": SIZE, **arguments})


def test_a_pixel_is_explained():
    scene = lcm.Scene.new()
    told = scene.explain(32, 18, SIZE)
    assert told["pixel"] == [32, 18]
    codes = scene.render(SIZE, samples=1)[18, 32]
    text = scene.explain_text(32, 18, SIZE)
    assert all(str(code) in text for code in codes)
    assert scene.explain_text(32, 18, SIZE, markdown=True) != text
    for x, y, text in [(64, 0, "x is 64"), (0, -1, "y is -1"), (0.5, 0, "x is 0.5"), (0, "3", "y is '3'")]:
        with pytest.raises(ValueError, match=text):
            scene.explain(x, y, SIZE)


def test_pictures_and_scenes_are_compared():
    scene = lcm.Scene.from_json(SCENES / "compare_phong_blinn_phong.json")
    a, b = (scene.render(SIZE, view=view) for view in "AB")
    by_arrays = lcm.compare(a, b)
    assert by_arrays.map.shape == (36, 64, 3) and by_arrays.covered is None
    by_scenes = lcm.compare(scene, scene, SIZE, views=("A", "B"))
    assert by_scenes.metrics["rmse"] == pytest.approx(by_arrays.metrics["rmse"]) and by_scenes.metrics["rmse"] > 0
    assert by_scenes.covered["rmse"] > by_scenes.metrics["rmse"]
    red = lcm.compare(a, b, channel="red", sign="signed", amplification=2)
    np.testing.assert_array_equal(red.differences, b[..., 0].astype(float) - a[..., 0])
    assert "rmse" in repr(red) and not np.array_equal(red.map, by_arrays.map)
    for more, text in [({"channel": "r"}, "channel is"), ({"sign": "plus"}, "sign is"), ({"amplification": 0}, "amplification")]:
        with pytest.raises(ValueError, match=text):
            lcm.compare(a, b, **more)
    same = lcm.compare(a, a)
    assert same.metrics["rmse"] == 0 and same.largest is None
    light = lcm.compare(scene.render(SIZE, linear=True), scene.render(SIZE, linear=True, view="B"))
    assert light.metrics["light_rmse"] > 0 and "rmse" not in light.metrics
    for x, y, error in [
        (a, b[:-1], ValueError), (a, b.astype(float), TypeError), (a, scene, TypeError), (a[0], b[0], ValueError),
        (np.full((4, 4, 3), np.nan), np.zeros((4, 4, 3)), ValueError), (a.astype(int), b.astype(int), TypeError),
        (np.zeros((0, 4, 3), np.uint8), np.zeros((0, 4, 3), np.uint8), ValueError),
    ]:
        with pytest.raises(error):
            lcm.compare(x, y)


def test_a_view_is_matched():
    scene = lcm.Scene.from_json(SCENES / "compare_phong_blinn_phong.json")
    found, nearer = scene.match("B", on="highlight", free=["alpha"])
    assert found["after"] < found["before"]
    assert nearer["variants[0].material.alpha"] == found["values"]["alpha"]
    logged, _ = scene.match("B", free=["alpha"], metric="log")
    assert logged["metric"] == "log" and "ln(1 + f cos" in logged["unit"]
    wrong = [({"view": "C"}, "there is no view"), ({"on": "colour"}, "on is"), ({"free": ["alhpa"]}, "alpha"), ({"metric": "eye"}, "metric is")]
    for arguments, text in wrong:
        with pytest.raises(ValueError, match=text):
            scene.match(**arguments)


def test_figures():
    phong, ward = lcm.Model("phong"), lcm.Model("ward")
    figure = lcm.plot([phong, ward], theta_i=30, log=True)
    assert figure.startswith(b"<svg") and figure._repr_svg_().rstrip().endswith("</svg>")
    assert b"<svg" in lcm.plot(phong, "slice") and b"<svg" in lcm.plot([], data=["krylon_blue"], theta_i=40)
    for arguments, text in [
        ({"models": []}, "nothing to plot"), ({"models": phong, "kind": "gloss"}, "must be one of"),
        ({"models": [], "data": ["krylon_blue"]}, "not at 45"),
        ({"models": phong, "theta_i": 95}, "less than 90"), ({"models": phong, "data": ["krylon"]}, "data is"),
        ({"models": phong, "channel": "cyan"}, "channel is"),
    ]:
        with pytest.raises(ValueError, match=text):
            lcm.plot(**arguments)
    with pytest.raises(TypeError, match="Model"):
        lcm.plot(["phong"])


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_ctrl_c_ends_long_work():
    setup = f"scene = lcm.Scene.from_json({str(SCENES / 'glass_ball.json')!r})"
    assert seconds_to_end(setup, "scene.render((1280, 720), light_samples=65536)", after=1) < 15


def test_measured_paints():
    blue = lcm.paint("krylon_blue")
    assert blue.l.shape == blue.v.shape == blue.f.shape and len(blue.f) > 100
    np.testing.assert_allclose(np.linalg.norm(blue.l, axis=-1), 1)
    assert blue.f[:, 2].mean() > blue.f[:, 0].mean(), "it is blue"
    with pytest.raises(ValueError, match="did you mean"):
        lcm.paint("krylon_blu")


def test_files_of_a_scene_are_found_again_from_another_folder(tmp_path, monkeypatch):
    (tmp_path / "tri.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n")
    told = lcm.Scene.new().to_dict()
    told["objects"] = [{"type": "mesh", "path": "tri.obj", "position": [5, 5, 5], "size": 1}]
    scene = lcm.Scene.from_dict(told, folder=tmp_path)
    monkeypatch.chdir(Path(tmp_path.anchor))
    again = pickle.loads(pickle.dumps(scene.set({"objects[0].size": 1.5})))
    np.testing.assert_array_equal(again.render(SIZE), scene.set({"objects[0].size": 1.5}).render(SIZE))
    with pytest.raises(lcm.SceneError, match="no such file"):
        lcm.Scene.from_dict(told)
