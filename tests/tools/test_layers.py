"""The layer check on small trees that break one rule each."""
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
        self.assertEqual(self.check({"src/core/error.cpp": "#include <mpi.h>\n"}),
                         ["src/core/error.cpp:1: includes no header of its layer, so nothing declares what it defines"])
        header = "include/poreshock/grid/exchange.hpp"
        found = self.check({header: "", "src/particles/exchange.cpp": '#include "particles.hpp"\n'})
        self.assertEqual(found, [f"src/particles/exchange.cpp:1: its header is {header}; a pair lies in one layer"])
        self.assertEqual(self.check({
            header: "", "src/grid/exchange.cpp": '#include "poreshock/grid/exchange.hpp"\n',
            "src/grid/exchange_rows.cpp": '#include "poreshock/grid/exchange.hpp"\n',
            "src/app/run.cpp": "", "src/scene/toml_reader.cpp": '#include "toml_reader.hpp"\n',
            "src/scene/toml_reader.hpp": "#include <toml++/toml.h>\n"}), [])

    def test_allowed_includes(self):
        self.assertEqual(self.check({
            "include/poreshock/physics/heat.hpp": '#include "poreshock/transfer/blocks.hpp"\n',
            "src/solver/ledger.hpp": '#include "poreshock/physics/heat.hpp"\n#include <mpi.h>\n',
            "src/files/hdf5_file.hpp": "#include <hdf5.h>\n", "src/app/main.cpp": "#include <CLI/CLI.hpp>\n",
            "include/poreshock/grid/partition.hpp": "", "src/grid/partition.cpp": '#include "poreshock/grid/partition.hpp"\n#include <metis.h>\n',
            "src/scene/scene.hpp": '#include "toml_reader.hpp"\n'}), [])

    def test_top_level(self):
        found = self.check({"README.md": "", ".gitignore": "", "build/x": "", "docs/x.md": "", "Makefile": ""})
        self.assertEqual([line.split(":")[0] for line in found], ["Makefile", "docs"])


if __name__ == "__main__":
    unittest.main()
