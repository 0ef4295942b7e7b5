"""Morphology of arrays of others: against plain counting, in all types, and what is refused."""
import unittest

import h5py
import numpy

import program

LEVELS = numpy.arange(1, 8) / 8


def random_image(shape, seed):
    """Noise in sixteenths, so that thresholds are met exactly."""
    return numpy.random.default_rng(seed).integers(0, 17, shape) / 16


def domains(white, around, corners):
    """Number of domains of the pixels in `white`, by flood fill; `around`: x wraps."""
    rows, columns = white.shape
    left = white.copy()
    number = 0
    for start in zip(*numpy.nonzero(white)):
        if not left[start]:
            continue
        number += 1
        left[start] = False
        stack = [start]
        while stack:
            z, x = stack.pop()
            for dz in (-1, 0, 1):
                for dx in (-1, 0, 1):
                    if dz and dx and not corners:
                        continue
                    to = (z + dz, (x + dx) % columns if around else x + dx)
                    if 0 <= to[0] < rows and 0 <= to[1] < columns and left[to]:
                        left[to] = False
                        stack.append(to)
    return number


def plain_counts(image, solid, around):
    """N, and per threshold: A, L and chi = V - E + F of white pixels, and n_W, n_B."""
    result = {"A": [], "L": [], "chi": [], "n_W": [], "n_B": []}
    for level in LEVELS:
        white = (image >= level) & solid
        black = ~white & solid
        padded = numpy.pad(white, ((1, 1), (0, 0)) if around else 1)
        right = numpy.roll(padded, -1, axis=1)
        columns = slice(None) if around else slice(0, -1)
        # An edge (vertex) is white when one of its two (four) pixels is.
        edges = (padded | right)[1:-1, columns].sum() + (padded[1:] | padded[:-1])[:, slice(None) if around
                                                                                   else slice(1, -1)].sum()
        pairs = (padded | right)[:, columns]
        vertices = (pairs[1:] | pairs[:-1]).sum()
        both = numpy.roll(solid, -1, axis=1) & solid & (numpy.roll(white, -1, axis=1) != white)
        length = both[:, slice(None) if around else slice(0, -1)].sum()
        length += (solid[1:] & solid[:-1] & (white[1:] != white[:-1])).sum()
        result["A"].append(white.sum() / solid.sum())
        result["L"].append(length / solid.sum())
        result["chi"].append((int(vertices) - int(edges) + int(white.sum())) / solid.sum())
        result["n_W"].append(domains(white, around, True))
        result["n_B"].append(domains(black, around, False))
    return result


class Arrays(program.ProgramTest):
    def check(self, name, image, solid, around, *options, ranks):
        output = f"out_{name.replace('/', '_').replace(':', '_')}_{ranks}_{around}_{len(options)}"
        self.succeed("analyze", name, "--thresholds", "0.125:0.875:0.125", "--output", output, *options,
                     *(["--periodic", "x"] if around else []), ranks=ranks)
        found = program.datasets(self.folder / output / "morphology.h5")
        found = {key.split("/", 1)[1]: values for key, values in found.items()}
        self.assertEqual(found["pixels"][0], solid.sum())
        for key, values in plain_counts(image, solid, around).items():
            numpy.testing.assert_array_equal(found[key][0], values, err_msg=f"{key} of {name}")

    def test_noise_as_counted_plainly(self):
        image = random_image((23, 31), 1)
        numpy.save(self.folder / "noise.npy", image)
        with h5py.File(self.folder / "noise.h5", "w") as file:
            file["deep/noise"] = image
        everywhere = numpy.ones(image.shape, bool)
        for ranks in (1, 4):
            for around in (False, True):
                self.check("noise.npy", image, everywhere, around, ranks=ranks)
                self.check("noise.h5:/deep/noise", image, everywhere, around, ranks=ranks)

    def test_voids_by_mask_and_by_nan(self):
        image = random_image((20, 17), 2)
        solid = random_image(image.shape, 3) > 0.2
        numpy.save(self.folder / "image.npy", image)
        numpy.save(self.folder / "mask.npy", solid)
        numpy.save(self.folder / "nan.npy", numpy.where(solid, image, numpy.nan))
        for ranks in (1, 3):
            self.check("image.npy", image, solid, True, "--mask", "mask.npy", ranks=ranks)
            self.check("nan.npy", image, solid, True, ranks=ranks)

    def test_number_types(self):
        image = numpy.random.default_rng(4).integers(0, 100, (12, 9))
        for kind in ("f8", "f4", "i8", "i4", "i2", "i1", "u8", "u4", "u2", "u1"):
            numpy.save(self.folder / f"{kind}.npy", image.astype(kind))
            self.succeed("analyze", f"{kind}.npy", "--thresholds", "50,80", "--output", kind)
            found = program.datasets(self.folder / kind / "morphology.h5")
            numpy.testing.assert_array_equal(found["array/F"][0], [(image >= 50).sum(), (image >= 80).sum()])

    def test_equal_to_a_threshold_is_white(self):
        """Tenths, of which most are no binary numbers: in any type and however the thresholds are written."""
        tenths = numpy.arange(110).reshape(10, 11) % 11
        expected = [(tenths >= k).sum() for k in range(1, 11)]
        levels = ",".join(f"{k / 10:g}" for k in range(1, 11))
        for kind in ("f4", "f8"):
            image = (tenths / 10).astype(kind)
            numpy.save(self.folder / f"tenths_{kind}.npy", image)
            with h5py.File(self.folder / f"tenths_{kind}.h5", "w") as file:
                file["map"] = image
            for name in (f"tenths_{kind}.npy", f"tenths_{kind}.h5:/map"):
                for number, written in enumerate((levels, "0.1:1:0.1")):
                    output = f"equal_{name.replace('/', '_')}_{number}"
                    self.succeed("analyze", name, "--thresholds", written, "--hot-spots", levels, "--field", "map",
                                 "--output", output, "--isoline")
                    found = program.datasets(self.folder / output / "morphology.h5")
                    numpy.testing.assert_array_equal(found["map/F"][0], expected, err_msg=output)
                    numpy.testing.assert_array_equal(found["map/threshold"], numpy.arange(1, 11) / 10)
                    spots = found["map/domains/threshold"]
                    areas = [found["map/domains/pixels"][spots == k / 10].sum() for k in range(1, 11)]
                    self.assertEqual(areas, expected)

    def test_voxels(self):
        image = random_image((9, 7, 8), 5)
        numpy.save(self.folder / "voxels.npy", image)
        for ranks in (1, 2):
            self.succeed("analyze", "voxels.npy", "--thresholds", "0.5,0.8", "--periodic", "x,y", "--output", f"vox{ranks}",
                         "--field", "noise", "--hot-spots", "0.8", "--pixel", "2e-6", ranks=ranks)
        self.assert_same_datasets("vox1/morphology.h5", "vox2/morphology.h5")
        found = program.datasets(self.folder / "vox1/morphology.h5")
        numpy.testing.assert_array_equal(found["noise/C"][0], [(image >= 0.5).sum(), (image >= 0.8).sum()])
        self.assertEqual(found["noise/domains/pixels"].sum(), (image >= 0.8).sum())
        self.assertEqual(len(found["noise/domains/pixels"]), found["noise/n_W"][0, 1])
        numpy.testing.assert_allclose(found["noise/domains/volume"], found["noise/domains/pixels"] * 8e-18, rtol=1e-12)

    def test_flags_and_integers_of_hdf5(self):
        image = numpy.random.default_rng(8).integers(0, 100, (12, 9))
        solid = random_image(image.shape, 9) > 0.3
        with h5py.File(self.folder / "kinds.h5", "w") as file:
            for kind in ("i8", "i4", "i2", "i1", "u8", "u4", "u2", "u1", ">i2", ">f4", ">f8"):
                file[f"map{kind}"] = image.astype(kind)
            file["flags"] = solid
            file["names"] = numpy.array(["a", "b"], dtype="S1")
            names = [name for name in file if name.startswith("map")]
        for name in names:
            self.succeed("analyze", f"kinds.h5:/{name}", "--thresholds", "50,80", "--mask", "kinds.h5:/flags",
                         "--output", name.replace(">", "big"))
        for path in self.folder.glob("map*/morphology.h5"):
            found = program.datasets(path)
            field = next(iter(found)).split("/")[0]
            numpy.testing.assert_array_equal(found[f"{field}/pixels"], [solid.sum()])
            numpy.testing.assert_array_equal(found[f"{field}/F"][0], [(image[solid] >= 50).sum(), (image[solid] >= 80).sum()])
        self.assertEqual(len(list(self.folder.glob("map*/morphology.h5"))), 11)
        # Flags as a map, and what holds no numbers.
        output = self.succeed("analyze", "kinds.h5:/flags", "--thresholds", "1", ranks=2).output
        self.assertIn(f"{solid.mean():.6g}", output)
        self.refuse("kinds.h5:/names: allowed are floating-point numbers of 32 and 64 bits, whole numbers and flags",
                    "analyze", "kinds.h5:/names", "--thresholds", "1")

    def test_doubtful_masks(self):
        image = random_image((6, 5), 10)
        image[4, 1:3] = numpy.nan
        solid = numpy.ones(image.shape)
        solid[0] = 0
        numpy.save(self.folder / "holes.npy", image)
        numpy.save(self.folder / "mask.npy", solid)
        for ranks in (1, 3):
            output = self.succeed("analyze", "holes.npy", "--mask", "mask.npy", "--thresholds", "0.5", ranks=ranks).output
            self.assertIn("array, 23 pixels of material", output)
            self.assertIn("  2 pixels are material by the mask but have no value (NaN); they count as void\n", output)
        doubtful = solid.copy()
        doubtful[2, 2] = doubtful[5, 0] = numpy.nan
        numpy.save(self.folder / "doubtful.npy", doubtful)
        numpy.save(self.folder / "empty.npy", 0 * solid)
        numpy.save(self.folder / "elsewhere.npy", numpy.isnan(image))
        numpy.save(self.folder / "nothing.npy", numpy.full((6, 5), numpy.nan))
        levels = ("--thresholds", "0.5", "--mask")
        for ranks in (1, 3):
            self.refuse("--mask: doubtful.npy has 2 NaN, allowed are 0 for void and other numbers for material",
                        "analyze", "holes.npy", *levels, "doubtful.npy", ranks=ranks)
            for mask in ("empty.npy", "elsewhere.npy"):
                self.refuse(f"--mask: {mask} leaves no pixel with a value; allowed are 0 for void and other numbers for "
                            "material, at least one", "analyze", "holes.npy", *levels, mask, ranks=ranks)
            self.refuse("nothing.npy: found nothing but NaN, allowed are numbers", "analyze", "nothing.npy", *levels[:2],
                        ranks=ranks)

    def test_pixels_that_are_none(self):
        numpy.save(self.folder / "good.npy", random_image((4, 5), 7))
        for pixel, text in (("0", "0"), ("-1e-6", "-1e-06"), ("nan", "nan"), ("inf", "inf"), ("-0.0", "-0")):
            self.refuse(f"--pixel: found {text}, allowed a finite number > 0 (m)", "analyze", "good.npy", "--thresholds",
                        "0.5", f"--pixel={pixel}")

    def test_damaged_headers(self):
        """Every header says what is wrong with it, and none ends the program in another way."""
        again = "; write it again with numpy.save(name, array)"

        def header(text, version=1, length=None):
            length = len(text) if length is None else length
            start = b"\x93NUMPY" + bytes([version, 0]) + length.to_bytes(2 if version == 1 else 4, "little")
            (self.folder / "header.npy").write_bytes(start + text.encode() + bytes(96))
            return self.message(2, "analyze", "header.npy", "--thresholds", "0.5").removeprefix("header.npy: ")

        good = "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }"
        self.succeed("analyze", self.save_with(good), "--thresholds", "0.5")
        damaged = "its header is damaged, it has "
        self.assertEqual(header("{'descr':"), damaged + "no type of the numbers ('descr')" + again)
        self.assertEqual(header("{'descr':   "), damaged + "no type of the numbers ('descr')" + again)
        self.assertEqual(header(""), damaged + "no type of the numbers ('descr')" + again)
        self.assertEqual(header("{'descr': '<f8', 'shape': (3, 4)}"), damaged + "no order of the numbers ('fortran_order')" + again)
        self.assertEqual(header("{'descr': '<f8', 'fortran_order': False}"), damaged + "no extents ('shape')" + again)
        self.assertEqual(header("{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4"), damaged + "no extents ('shape')" + again)
        for shape in ("(3, -4)", "(3, x)", "3", "(3, 99999999999999999999999)", "(3 4)", "(3.5, 2)"):
            self.assertEqual(header(good.replace("(3, 4)", shape)),
                             damaged + f"the extents {shape}, allowed are some like (3, 4)" + again)
        for shape in ("(3, 5)", "(4294967296, 4294967296)", "(4294967296, 4294967296, 4294967297)"):
            self.assertRegex(header(good.replace("(3, 4)", shape)),
                             r"^truncated, it is shorter than its header says: it ends in row \d of \d+$")
        self.assertEqual(header(good, version=9), damaged + "the version 9, allowed are 1 to 3" + again)
        self.assertEqual(header(good, length=40000), "truncated")
        self.assertIn("found numbers of type '>f8'; allowed are", header(good.replace("<", ">")))
        self.assertIn("found numbers of type [('a'; allowed are", header(good.replace("'<f8'", "[('a', '<f8')]")))
        self.assertIn("dimensions without numbers", header(good.replace("(3, 4)", "(3, 0)")))
        self.assertIn("found an array of 0 dimensions", header(good.replace("(3, 4)", "()")))

    def save_with(self, header):
        start = b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little")
        (self.folder / "whole.npy").write_bytes(start + header.encode() + bytes(96))
        return "whole.npy"

    def test_refusals(self):
        numpy.save(self.folder / "line.npy", numpy.ones(5))
        numpy.save(self.folder / "columns.npy", numpy.asfortranarray(random_image((4, 5), 6)))
        numpy.save(self.folder / "good.npy", random_image((4, 5), 7))
        numpy.save(self.folder / "other.npy", random_image((5, 4), 7))
        whole = (self.folder / "good.npy").read_bytes()
        (self.folder / "cut.npy").write_bytes(whole[:-1])
        levels = ("--thresholds", "0.5")
        self.refuse("line.npy: found an array of 1 dimensions, allowed 2 or 3, the last one x and the first one the shock "
                    "axis", "analyze", "line.npy", *levels)
        self.assertIn("columns first; allowed are little-endian", self.message(2, "analyze", "columns.npy", *levels))
        self.refuse("cut.npy: truncated, it is shorter than its header says: it ends in row 4 of 4", "analyze", "cut.npy", *levels, ranks=2)
        self.refuse("none.npy: not found", "analyze", "none.npy", *levels, ranks=2)
        self.refuse("--mask: other.npy has another shape than good.npy", "analyze", "good.npy", *levels, "--mask", "other.npy")
        self.refuse('--periodic: found "y", allowed x for a map of two dimensions',
                    "analyze", "good.npy", *levels, "--periodic", "y")


if __name__ == "__main__":
    unittest.main()
