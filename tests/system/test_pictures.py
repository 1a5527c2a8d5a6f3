"""Goal: the bodies of a run are seen: in its page, as a picture, as a film. Oracles: a run made by
hand (made_fields.py), whose places and stresses are known at every node and time; the page's block
of numbers, read here a second time; colours of pixels.

usage: test_pictures.py REPORT FILM PICTURE   (ends with 77 where packages of pictures are missing)
"""

import array
import base64
import json
import random
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import zlib
from pathlib import Path
from unittest import mock

from made_fields import PEAK, PUSH, TIMES, brick, make_fields, make_run, state, way

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
sys.dont_write_bytecode = True
from abut_tools import bodies_page  # noqa: E402
from abut_tools.motion import motion_of  # noqa: E402
from abut_tools.run_folder import Run  # noqa: E402
from abut_tools.surfaces import clustered, surface_of  # noqa: E402
from abut_tools.vtu import Grid, State  # noqa: E402

SKIPPED = 77
REPORT, FILM, PICTURE = sys.argv[1:4]
ADVICE = r"\Aabut (report|film|picture): [^\n]+\. [A-Z][^\n]+\n\Z"


def call(program: str, *arguments, **options) -> subprocess.CompletedProcess:
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True,
                          timeout=120, check=False, **options)


def grid_of(points: list, cells: list, kind: int) -> Grid:
    ends = [sum(map(len, cells[: k + 1])) for k in range(len(cells))]
    return Grid(array.array("d", [x for p in points for x in p]),
                array.array("i", [node for cell in cells for node in cell]),
                array.array("i", ends), array.array("B", [kind] * len(cells)))


class Made(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp()) / "run"
        self.addCleanup(shutil.rmtree, self.folder.parent)

    def succeed(self, program: str, *arguments) -> Path:
        result = call(program, *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return Path(result.stdout.strip())

    def refused(self, code: int, program: str, *arguments, **options) -> str:
        result = call(program, *arguments, **options)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        self.assertRegex(result.stderr, ADVICE)
        return result.stderr


class Surfaces(unittest.TestCase):
    def test_what_two_cells_share_is_not_seen(self):
        surface = surface_of(grid_of(*brick(0.0, 3)))
        self.assertEqual((len(surface.triangles), len(surface.nodes)), (2 * 10, 12))
        self.assertEqual((len(surface.edges), surface.dimension), (20, 3))

    def test_every_edge_of_a_closed_surface_has_two_triangles(self):
        # hexahedron, tetrahedron, wedge, pyramid and two of second order, nodes at any place
        for kind, count in ((12, 8), (10, 4), (13, 6), (14, 5), (24, 10), (25, 20)):
            with self.subTest(kind=kind):
                points = [(float(k), float(k * k), float(k ** 3)) for k in range(count)]
                surface = surface_of(grid_of(points, [tuple(range(count))], kind))
                sides = {}
                for a, b, c in surface.triangles:
                    for edge in ((a, b), (b, c), (c, a)):
                        sides[edge] = sides.get(edge, 0) + 1
                self.assertTrue(all(sides.get((b, a)) == number == 1
                                    for (a, b), number in sides.items()), sides)
                self.assertEqual(len(surface.nodes), count)

    def test_a_bar_is_a_strip_and_a_wall_a_line(self):
        bar = surface_of(grid_of([(x, 0.0, 0.0) for x in (0.0, 1.0, 2.0)], [(0, 1), (1, 2)], 3))
        self.assertEqual((len(bar.nodes), len(bar.triangles), bar.dimension), (6, 4, 1))
        wall = surface_of(grid_of([(0.0, 0.0, 0.0)], [(0,)], 1))
        self.assertEqual((wall.triangles, wall.edges, wall.dimension), ([], [(0, 1)], 0))

    def test_a_thinned_surface_keeps_its_shape(self):
        side = range(21)
        points = [(x / 20, y / 20, 0.0) for y in side for x in side]
        cells = [(k, k + 1, k + 22, k + 21) for k in range(20 * 21) if k % 21 < 20]
        whole = surface_of(grid_of(points, cells, 9))
        thin = clustered(whole, points, 100)
        self.assertLessEqual(len(thin.nodes), 100)
        self.assertGreater(len(thin.nodes), 50)
        places = [points[node] for node in thin.nodes]
        area = 0.0
        for a, b, c in thin.triangles:
            (ax, ay, _), (bx, by, _), (cx, cy, _) = (places[k] for k in (a, b, c))
            area += 0.5 * abs((bx - ax) * (cy - ay) - (cx - ax) * (by - ay))
        # nodes of the rim move by less than a cell of the lattice, of which there are ten across
        self.assertAlmostEqual(area, 1.0, delta=0.2)


class Pages(Made):
    def moving(self, dimension: int) -> tuple[str, dict]:
        shutil.rmtree(self.folder, ignore_errors=True)
        make_run(self.folder, dimension)
        page = self.succeed(REPORT, self.folder).read_text(encoding="utf-8")
        data = re.search(r"<script>const moving = (.*?);</script>", page, re.DOTALL)[1]
        return page, json.loads(data)

    def test_the_block_of_a_page_holds_places_and_stresses(self):
        for dimension in (2, 3):
            with self.subTest(dimension=dimension):
                _, data = self.moving(dimension)
                self.assertEqual(data["dimension"], dimension)
                self.assertEqual(data["times"], [0.0, 1.0, 2.0, 3.0])  # ms
                self.read_block(data, dimension)

    def read_block(self, data: dict, dimension: int) -> None:
        block, at = zlib.decompress(base64.b64decode(data["block"])), 0

        def words(count: int) -> array.array:
            nonlocal at
            numbers = array.array("H", block[at: at + 2 * count])
            at += 4 * ((count + 1) // 2)
            return numbers

        def states(count: int) -> list[list[int]]:
            every = words(count * len(TIMES))
            rows, before = [], [0] * count
            for k in range(len(TIMES)):
                before = [(a + b) % 65536 for a, b in
                          zip(before, every[k * count: (k + 1) * count])]
                rows.append(before)
            return rows

        shade = data["shades"][0]
        for body, shift in zip(data["bodies"], (-2.0, 0.01)):
            points, n = brick(shift, dimension)[0], body["nodes"]
            self.assertEqual(n, len(points))
            for i in range(dimension):
                low, high = body["low"][i], body["high"][i]
                for q, point in zip(words(n), points):
                    self.assertAlmostEqual(low + q / 65535 * (high - low), point[i], places=4)
            at += 4 * (3 * body["triangles"] + 2 * body["edges"])
            ahead = PUSH if body["name"] == "right" else 0.0
            for k, mean in enumerate(body["means"]):
                self.assertAlmostEqual(mean[0], -ahead * k / 3, places=9)
            for _ in range(dimension):
                states(n)  # no brick deforms
            self.assertEqual(body["keys"], ["stress", "displacement"])
            stress, _ = states(n), states(n)
            for k, row in enumerate(stress):
                most = PEAK * k / 3 if body["name"] == "right" else 0.0
                self.assertAlmostEqual(shade["least"] + max(row) / 65535 *
                                       (shade["most"] - shade["least"]), most, delta=PEAK / 65535)
        self.assertEqual(at, len(block), "and nothing else")

    def test_what_happened_and_warnings_stand_before_the_bodies_and_the_curves(self):
        page, _ = self.moving(3)
        order = [page.index(f"<h2>{title}</h2>")
                 for title in ("What happened", "Warnings", "The bodies", "Figures")]
        self.assertEqual(order, sorted(order))
        self.assertIn("completed, 1 warning<", page)
        self.assertIn("1 ms: right turns too far", page)
        self.assertIn("<td>3 kN</td>", page)
        self.assertNotIn("Dashed: closed form", page, "no legend for what is not there")

    def test_text_says_what_the_bodies_show(self):
        page, _ = self.moving(3)
        words = re.search('<canvas id="bodies"[^>]*aria-label="([^"]*)"', page)[1]
        self.assertEqual(words, "The bodies left, right moving; colours: von Mises stress from 0 "
                                "to 2 MPa; displacement from 0 to 50 mm")

    def test_a_run_without_fields_says_how_to_get_the_bodies(self):
        make_run(self.folder)
        shutil.rmtree(self.folder / "fields")
        (self.folder / "fields.pvd").unlink()
        page = self.succeed(REPORT, self.folder).read_text(encoding="utf-8")
        self.assertIn("--set output.fields.every=3<", page)  # of 300 windows
        self.assertIn("const moving = null;", page)

    def test_damaged_fields_are_told_in_one_line(self):
        make_run(self.folder)
        path = self.folder / "fields" / "right_000002.vtu"
        whole = path.read_text()
        for name, text in (
                ("cut short", whole[: len(whole) // 2]), ("empty", ""), ("no grid", "<a/>"),
                ("other numbers", whole.replace('Name="displacement" N', 'Name="displacement " N')
                 .replace('NumberOfPoints="12"', 'NumberOfPoints="13"')),
                ("overwritten", re.sub(r"(nodal_von_mises[^>]*>.{60}).{40}", r"\1" + "A" * 40,
                                       whole)),
                ("no text", whole.replace("eJ", "\x00"))):
            with self.subTest(name):
                path.write_text(text)
                for program in (REPORT, PICTURE):
                    self.assertIn("right_000002.vtu", self.refused(2, program, self.folder))
        path.unlink()
        self.assertIn("is not there", self.refused(2, REPORT, self.folder))
        (self.folder / "fields.pvd").write_text("<VTKFile><Collection><DataSet timestep='0' "
                                                "name='a' file='../summary.json'/></Collection>"
                                                "</VTKFile>")
        self.assertIn("no file of fields/", self.refused(2, REPORT, self.folder))


    def test_bodies_that_are_too_large_for_a_page_are_thinned_and_it_says_so(self):
        chance = random.Random(1)  # no two numbers alike: nothing packs well
        points = [(x / 40, y / 40, 0.0) for y in range(41) for x in range(41)]
        cells = [(k, k + 1, k + 42, k + 41) for k in range(40 * 41) if k % 41 < 40]
        (self.folder / "fields").mkdir(parents=True)
        lines = ""
        for k in range(50):
            moved = [tuple(1e-3 * chance.random() for _ in range(3)) for _ in points]
            (self.folder / f"fields/plate_{k:06}.vtu").write_text(
                state(points, cells, 9, moved, [chance.random() for _ in points]))
            lines += f'<DataSet timestep="{k}" name="plate" file="fields/plate_{k:06}.vtu"/>'
        (self.folder / "fields.pvd").write_text(
            f"<VTKFile><Collection>{lines}</Collection></VTKFile>")
        for limit, states, nodes in ((10_000_000, 50, 1681), (800_000, 30, 1681),
                                     (100_000, 30, 1000)):
            with mock.patch.object(bodies_page, "LIMIT", limit):
                motion, data = bodies_page.fitting_motion(self.folder, (1.0, "s"))
            self.assertLessEqual(len(data["block"]), limit)
            self.assertLessEqual(len(motion.bodies[0].rest), nodes)
            self.assertGreater(len(motion.bodies[0].rest), 100)
            self.assertLessEqual(len(motion.times), 50)
            self.assertGreaterEqual(len(motion.times), states)
            words = bodies_page.words_of(motion)
            self.assertEqual("fewer nodes" in words, nodes < 1681, words)
            self.assertEqual("of the 50 states" in words, limit < 10_000_000, words)


class Pictures(Made):
    def image(self, *arguments):
        from PIL import Image
        with Image.open(self.succeed(PICTURE, self.folder, *arguments)) as opened:
            self.assertEqual(opened.format, "PNG")
            return opened.convert("RGB")

    def test_pixels_have_the_colours_of_the_stress(self):
        make_run(self.folder, 2)
        image = self.image("--size", "960x540", "--time", TIMES[-1], "--field", "stress")
        self.assertEqual(image.size, (960, 540))
        # across both bricks, which lie in a row above the curve
        row = [image.getpixel((x, 110)) for x in range(20, 940)]
        blue = [pixel for pixel in row if pixel[2] > pixel[0] + 40]
        yellow = [pixel for pixel in row if pixel[0] > pixel[2] + 60]
        self.assertGreater(len(blue), 150, "the left brick is without stress")
        self.assertGreater(len(yellow), 20, "the right one has it where they meet")
        first = self.image("--time", 0.0)
        self.assertFalse([pixel for pixel in (first.getpixel((x, 110)) for x in range(20, 940))
                          if pixel[0] > pixel[2] + 60], "at the begin nothing is stressed")

    def test_bars_have_a_diagram_of_space_and_time(self):
        make_run(self.folder, 1)
        image = self.image("--size", "900x600", "--field", "displacement")
        # below the strips: the left bar stands still, the right one comes from the right
        plane = [[image.getpixel((x, y)) for x in range(120, 860)] for y in range(200, 354)]
        moved = [sum(pixel[2] > pixel[0] + 60 for pixel in row) for row in plane]
        upper, lower = moved[:70], moved[84:]
        self.assertGreater(sum(upper), 5000, "places go up, and the right bar is above")
        self.assertLess(sum(lower), 500)
        early = sum(row[k][2] > row[k][0] + 60 for row in plane for k in range(100))
        late = sum(row[-k][2] > row[-k][0] + 60 for row in plane for k in range(1, 101))
        self.assertGreater(late, 5 * early + 1000, "time goes to the right")

    def test_what_is_in_front_hides_what_is_behind(self):
        make_run(self.folder, 3)
        # along x from the right: the right brick, the left one behind it
        image = self.image("--view", "x", "--field", "bodies", "--size", "600x400")
        ahead = image.getpixel((170, 180))
        behind = self.image("--view", "-90,0", "--field", "bodies", "--size",
                            "600x400").getpixel((170, 180))
        self.assertGreater(ahead[0], ahead[2] + 40, "orange is the second body")
        self.assertGreater(behind[2], behind[0] + 40, "blue is the first")

    def test_dark_pictures_and_every_size_are_drawn(self):
        make_run(self.folder, 3)
        for size in ("390x700", "800x600", "1920x1080"):
            image = self.image("--dark", "--size", size)
            self.assertEqual("x".join(map(str, image.size)), size)
            self.assertLess(sum(image.getpixel((2, 2))), 120)
            self.assertGreater(len(set(image.getdata())), 50)

    def test_a_film_has_every_state(self):
        from PIL import Image, ImageChops
        make_run(self.folder, 3)
        with Image.open(self.succeed(FILM, self.folder, "--out", self.folder / "f.gif", "--size",
                                     "400x300")) as film:
            self.assertEqual((film.format, film.n_frames, film.size), ("GIF", 4, (400, 300)))
            self.assertEqual(film.info.get("loop"), 0)
            frames = []
            for k in range(film.n_frames):
                film.seek(k)
                frames.append(film.convert("RGB"))
        for one, other in zip(frames, frames[1:]):
            self.assertIsNotNone(ImageChops.difference(one, other).getbbox(), "bodies move")
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()),
                         ["events.jsonl", "f.gif", "fields", "fields.pvd", "history.csv",
                          "summary.json"], "and nothing is left behind")

    def test_ffmpeg_makes_films_where_it_is(self):
        make_run(self.folder, 2)
        out = self.succeed(FILM, self.folder, "--size", "401x301")
        self.assertEqual(out.suffix, ".mp4" if shutil.which("ffmpeg") else ".gif")
        self.assertGreater(out.stat().st_size, 1000)
        gif = call(FILM, self.folder, env={"PATH": "/nonexistent"})
        self.assertEqual(gif.stdout.strip(), str(self.folder / "film.gif"), gif.stderr)
        self.assertIn("apt-get install --no-install-recommends ffmpeg", self.refused(
            3, FILM, self.folder, "--out", "x.mp4", env={"PATH": "/nonexistent"}))

    def test_wrong_wishes_are_refused_with_the_right_ones(self):
        make_run(self.folder, 2)
        self.assertIn("from 0 to 0.003 s", self.refused(2, PICTURE, self.folder, "--time", 1.0))
        self.assertIn("Name one of stress, displacement, bodies",
                      self.refused(2, PICTURE, self.folder, "--field", "pressure"))
        self.assertIn("ending .png", self.refused(2, PICTURE, self.folder, "--out", "x.jpg"))
        self.assertIn("ending .gif", self.refused(2, FILM, self.folder, "--out", "x.avi"))
        for words in (("--size", "9"), ("--view", "up"), ("--time", "soon"),
                      ("--deformation", "-1"), ("--size", "99999x99999")):
            result = call(PICTURE, self.folder, *words)
            self.assertEqual(result.returncode, 2, words)
            self.assertIn(f"argument {words[0]}", result.stderr)

    def test_a_run_without_fields_names_the_key(self):
        make_run(self.folder, 2)
        (self.folder / "fields.pvd").unlink()
        for program in (FILM, PICTURE):
            self.assertIn("--set output.fields.every=", self.refused(2, program, self.folder))

    def test_missing_packages_are_named_with_the_command(self):
        make_run(self.folder, 2)
        fake = self.folder.parent / "fake"
        fake.mkdir()
        (fake / "matplotlib.py").write_text("raise ImportError('not here')\n")
        said = self.refused(3, PICTURE, self.folder, env={"PYTHONPATH": str(fake), "PATH": "/bin"})
        self.assertIn("apt-get install --no-install-recommends python3-matplotlib\n", said)


class Words(Made):
    def test_pages_and_pictures_have_the_words_of_a_scene_that_declares_its_system(self):
        from abut_tools.frames import Frames, Look
        make_run(self.folder, 2)
        path = self.folder / "summary.json"
        summary = json.loads(path.read_text(encoding="utf-8"))
        summary["units"] = {"m": "mm", "s": "ms", "m/s": "mm/ms", "N": "kN", "Pa": "GPa"}
        path.write_text(json.dumps(summary), encoding="utf-8")
        run = Run(self.folder)
        motion, data = bodies_page.fitting_motion(self.folder, run.time_scale(), run.units)
        self.assertEqual((data["time"], data["length"]["unit"]), ("ms", "mm"))
        self.assertEqual({shade["key"]: shade["unit"] for shade in data["shades"]},
                         {"stress": "GPa", "displacement": "mm"})
        self.assertIn(" GPa; displacement from ", bodies_page.alternative(motion))
        frames = Frames(run, motion_of(self.folder, 2), Look((400, 300), "", None, 1.0, False))
        self.assertEqual((frames.time_unit, frames.curve.label), ("ms", "force [kN]"))
        frames.draw(1)
        self.assertEqual(frames.clock.get_text(), "t = 0.003 ms")
        told = self.refused(2, PICTURE, self.folder, "--time", "5")
        self.assertIn("which go from 0 to 0.003 ms. ", told)


class Motions(Made):
    def test_states_are_chosen_evenly_and_the_wanted_one_is_among_them(self):
        make_fields(self.folder)
        self.assertEqual(motion_of(self.folder, 2).times, [TIMES[0], TIMES[-1]])
        self.assertEqual(motion_of(self.folder, 2, also=1.1e-3).times, [TIMES[0], 1e-3, TIMES[-1]])
        body = motion_of(self.folder, 9).bodies[1]
        self.assertEqual([moved[0] for moved in body.displacements], [-way(k) for k in range(4)])

    def test_an_array_that_is_too_long_is_refused(self):
        make_fields(self.folder)
        state = State(self.folder / "fields" / "left_000000.vtu")
        self.assertEqual(len(state.at_nodes("displacement", 3)), 36)
        with self.assertRaisesRegex(Exception, "36 numbers in displacement instead of 12"):
            state.at_nodes("displacement", 1)


if __name__ == "__main__":
    try:
        import matplotlib  # noqa: F401
        import numpy  # noqa: F401
        import PIL  # noqa: F401
    except ImportError as error:
        print(f"skipped: {error}")
        sys.exit(SKIPPED)
    unittest.main(argv=sys.argv[:1])
