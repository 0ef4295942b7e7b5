"""The check of layers and sizes on small trees that break one rule each."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
import check_layers  # noqa: E402


class Layers(unittest.TestCase):
    def check(self, files):
        """Problems of a tree of {path: text}."""
        with tempfile.TemporaryDirectory() as name:
            for path, text in files.items():
                (Path(name) / path).parent.mkdir(parents=True, exist_ok=True)
                (Path(name) / path).write_text(text)
            return list(check_layers.problems(Path(name).resolve()))

    def one(self, path, include, also=None):
        """The only problem of a header or source with one include on its second line."""
        header = path.replace("src/", "include/poreshock/").replace(".cpp", ".hpp")
        own = f'#include "{header.removeprefix("include/")}"\n'
        found = self.check({header: "", path: f"// text\n#include {include}\n{own}"} | (also or {}))
        self.assertEqual(len(found), 1, found)
        self.assertTrue(found[0].startswith(f"{path}:2: "), found)
        return found[0]

    def test_includes_point_down(self):
        for path, target in (("src/core/error.cpp", "scene/scene.hpp"),
                             ("include/poreshock/grid/slab_grid.hpp", "transfer/blocks.hpp"),
                             ("src/sample/fill.cpp", "output/snapshot.hpp"),
                             ("src/physics/stress.cpp", "morphology/minkowski.hpp"),
                             ("src/output/history.cpp", "transfer/blocks.hpp"),
                             ("src/morphology/pixel_map.cpp", "particles/particles.hpp"),
                             ("src/solver/simulation.cpp", "app/main.hpp")):
            self.assertIn(f"includes poreshock/{target}; it may include", self.one(path, f'"poreshock/{target}"'))

    def test_libraries_stay_in_their_layer(self):
        for path, include, where in (("src/app/main.cpp", "<toml++/toml.h>", "src/scene"),
                                     ("include/poreshock/scene/read_scene.hpp", "<toml++/toml.h>", "src/scene"),
                                     ("src/solver/ledger.cpp", "<hdf5.h>", "the files layer"),
                                     ("src/core/phase.cpp", "<H5Ppublic.h>", "the files layer"),
                                     ("src/grid/slab_grid.cpp", "<metis.h>", "src/grid/partition.cpp"),
                                     ("src/scene/read_scene.cpp", "<CLI/CLI.hpp>", "the app layer")):
            self.assertIn(f"only {where} may", self.one(path, include))

    def test_unknown_layers_and_foreign_private_headers(self):
        self.assertIn("no layer 'mesh'", self.one("src/core/error.cpp", '"poreshock/mesh/mesh.hpp"'))
        self.assertIn("own folder only", self.one("src/app/main.cpp", '"../scene/toml_reader.hpp"'))
        self.assertIn("lies in no layer", self.check({"src/mesh/mesh.cpp": ""})[0])

    def test_sources_belong_to_a_header_of_their_layer(self):
        self.assertEqual(self.check({"include/poreshock/core/error.hpp": "", "src/core/error.cpp": "#include <mpi.h>\n"}),
                         ["src/core/error.cpp:1: includes no header of its layer, so nothing declares what it defines"])
        header = "include/poreshock/grid/exchange.hpp"
        found = self.check({header: "", "src/particles/exchange.cpp": '#include "particles.hpp"\n'})
        self.assertEqual(found[:1], [f"src/particles/exchange.cpp:1: its header is {header}; a pair lies in one layer"])
        self.assertEqual(self.check({
            header: "", "src/grid/exchange.cpp": '#include "poreshock/grid/exchange.hpp"\n',
            "src/app/main.cpp": "", "src/scene/toml_reader.cpp": '#include "toml_reader.hpp"\n',
            "src/scene/toml_reader.hpp": "#include <toml++/toml.h>\n"}), [])

    def test_allowed_includes(self):
        self.assertEqual(self.check({
            "include/poreshock/physics/heat.hpp": '#include "poreshock/transfer/blocks.hpp"\n',
            "src/solver/ledger.hpp": '#include "poreshock/physics/heat.hpp"\n#include <mpi.h>\n',
            "src/files/hdf5_file.hpp": "#include <hdf5.h>\n", "src/app/main.cpp": "#include <CLI/CLI.hpp>\n",
            "include/poreshock/grid/partition.hpp": "", "src/grid/partition.cpp": '#include "poreshock/grid/partition.hpp"\n#include <metis.h>\n',
            "src/scene/scene.hpp": '#include "toml_reader.hpp"\n'}), [])

    def sizes(self, text, standing="", path="include/poreshock/grid/rows.hpp"):
        """Problems of one file, with the list of what is let stand, without their place."""
        found = self.check({path: text, "tools/check_layers.txt": "# a comment\n" + standing})
        return [line.split(": ", 1)[1] for line in found]

    def test_bodies_have_at_most_40_lines(self):
        def function(lines):
            body = "  a = '}'; // not {\n" * lines
            return "template <class A = int>\nauto sum(A a, int b) -> A {\n" + body + "}\nint one() { return 1; }\n"
        self.assertEqual(self.sizes(function(40)), [])
        self.assertEqual(self.sizes(function(41)), ["'sum' has 41 lines; at most 40 are allowed"])
        members = ("namespace n {\nstruct S : B {\n  S() : a{1}, b(2) {\n" + "f();\n" * 41 + "  }\n"
                   "  void operator()(int) const {" + "\n" * 42 + "}\n};\n}\n")
        self.assertEqual(self.sizes(members), ["'S' has 41 lines; at most 40 are allowed",
                                               "'operator()' has 41 lines; at most 40 are allowed"])
        self.assertEqual(self.sizes("template <>\nvoid turn<2>() {" + "\n" * 42 + "}\n"),
                         ["'turn<2>' has 41 lines; at most 40 are allowed"])
        # Tables and types are no functions.
        tables = "constexpr int table[] = {" + "1,\n" * 50 + "};\nstruct S {" + "int a;\n" * 50 + "};\n"
        self.assertEqual(self.sizes(tables), [])

    def test_functions_take_at_most_7_arguments(self):
        arguments = "std::pair<int, int> a, int (*b)(int, int), int c = f(1, 2), int d = {}, int e, int f"
        self.assertEqual(self.sizes(f"void f({arguments}, int g) {{}}\n"), [])
        self.assertEqual(self.sizes(f"// a text\n\nvoid f({arguments}, int g,\n       int h) {{}}\n"),
                         ["'f' takes 8 arguments; at most 7 are allowed"])

    def test_files_have_at_most_300_lines(self):
        for path in ("include/poreshock/grid/rows.hpp", "tests/grid/test_rows.cpp", "tools/report.py", "tools/test"):
            self.assertEqual(self.sizes("\n" * 300, path=path), [])
            self.assertEqual(self.sizes("\n" * 301, path=path), ["has 301 lines; at most 300 are allowed"])
        self.assertEqual(self.sizes("\n" * 301, path="tests/grid/README.md"), [])

    def test_sources_have_a_header_of_their_name(self):
        own = {"include/poreshock/grid/rows.hpp": ""}
        text = '#include "poreshock/grid/rows.hpp"\n'
        self.assertEqual(self.check(own | {"src/grid/rows.cpp": text}), [])
        self.assertEqual(self.check({"src/grid/rows.hpp": "", "src/grid/rows.cpp": '#include "rows.hpp"\n'}), [])
        self.assertEqual(self.check(own | {"src/grid/more_rows.cpp": text}), [
            "src/grid/more_rows.cpp:1: has no header, include/poreshock/grid/more_rows.hpp or src/grid/more_rows.hpp, and "
            "no header of its layer names it"])
        own["include/poreshock/grid/rows.hpp"] = "// Rows. Also in more_rows.cpp.\n"
        self.assertEqual(self.check(own | {"src/grid/more_rows.cpp": text}), [])

    def test_what_stands_may_only_shrink(self):
        path = "include/poreshock/grid/rows.hpp"
        text = "void f(int, int, int, int, int, int, int, int) {" + "\n" * 46 + "}\n" + "\n" * 270
        list_of = f"body {path}:f {{}}\narguments {path}:f 8\nfile {path} 320\n".format
        self.assertEqual(self.sizes(text, list_of(45)), [])
        self.assertEqual(self.sizes(text, list_of(44)), ["'f' has 45 lines; at most 44 are allowed"])
        self.assertEqual(self.sizes("void f() {}\n", list_of(45)), [
            f"'{entry}' is beyond no limit; strike the line"
            for entry in (f"arguments {path}:f", f"body {path}:f", f"file {path}")])
        self.assertEqual(self.sizes("", "nonsense\n"), ["'nonsense ' is beyond no limit; strike the line"])

    def test_top_level(self):
        found = self.check({"README.md": "", ".gitignore": "", "build/x": "", "docs/x.md": "", "Makefile": ""})
        self.assertEqual([line.split(":")[0] for line in found], ["Makefile", "docs"])


if __name__ == "__main__":
    unittest.main()
