"""Hard cases that must repeat themselves: restarts, ranks, scales, mirror and shift."""
import numpy

from poreshock_cases.table import check, limit, same

SCENE = "hard/powers_of_two.toml"
LENGTHS = {"domain": ("size", "cell"), "sample": ("height",), "time": ("end",), "output": ("beat",)}
SITES = 64  # particles of a full row
VARIANTS = {
    "default": (),
    "cubic APIC": ("transfer.velocity=apic",),
    "paper, kinematic": ("thermal=paper", "material.0.kinematic_share=1"),
    "quadratic FLIP, damped": ("transfer.shape=quadratic", "transfer.velocity=flip", "transfer.damping=0.1"),
}


def folder_of(name):
    return name.replace(",", "").replace(" ", "_")


def restart(case, lab):
    """Restarts in the middle of the shock, on other numbers of ranks too."""
    rows = []
    for name, settings in VARIANTS.items():
        whole = lab.run(folder_of(name), SCENE, "checkpoint.every_steps=40", "checkpoint.keep=99", *settings)
        checkpoint = sorted(whole.folder.glob("checkpoint_*.h5"))[0]
        sums = [whole.checksum]
        for ranks in (1, 2, 3):
            again = lab.run(f"{folder_of(name)}_{ranks}", SCENE, *settings, ranks=ranks, restart=checkpoint)
            sums.append(again.checksum)
        rows.append(same(case, f"{name}: whole run, restarts on 1, 2, 3 ranks", sums))
    return rows


def ranks(case, lab):
    """Cuts through the voids."""
    return [same(case, f"{name}: 1, 2, 3, 4 ranks",
                 [lab.run(f"{folder_of(name)}_{count}", SCENE, *settings, ranks=count).checksum
                  for count in (1, 2, 3, 4)])
            for name, settings in VARIANTS.items()]


def scaled(value, factor):
    return [scaled(part, factor) for part in value] if isinstance(value, list) else value * factor


def scale_settings(scene, factor):
    """All lengths and times of a scene times `factor`."""
    settings = [f"{table}.{key}={scaled(scene[table][key], factor)!r}"
                for table, keys in LENGTHS.items() for key in keys]
    for i, void in enumerate(scene["void"]):
        settings += [f"void.{i}.{key}={scaled(void[key], factor)!r}" for key in ("center", "radius")]
    return settings


def scale(case, lab):
    """The same scene with lengths and times times 8 and 1/1024."""
    base = lab.run("one", SCENE)
    first = base.particles()
    rows = []
    for power in (3, -10):
        other = lab.run(f"two_to_{power}", SCENE, *scale_settings(base.scene, 2.0**power)).particles()
        equal = all(numpy.array_equal(first[name], other[name]) for name in
                    ("temperature", "pressure", "stress", "density", "velocity", "plastic_strain"))
        equal = equal and numpy.array_equal(first["position"] * 2.0**power, other["position"])
        rows.append(check(case, f"lengths and times times 2^{power}: T, P, stress, rho, v, eps_p, x",
                          "identical" if equal else "different", "identical", equal))
    return rows


def moved(base, move):
    """Settings that put the voids at move(x)."""
    return [f"void.{i}.center={[move(void['center'][0]), void['center'][1]]!r}"
            for i, void in enumerate(base.scene["void"])]


def difference(first, other, site):
    """Largest difference of T and P after lattice column i has become column site(i)."""
    column = first["id"] % SITES
    partner = numpy.searchsorted(other["id"], first["id"] - column + site(column))
    return max(float(numpy.max(abs(first[name] - other[name][partner])) / numpy.max(abs(first[name])))
               for name in ("temperature", "pressure"))


def symmetry(case, lab):
    """Mirrored sample, and a sample shifted by one cell through the periodic side."""
    base = lab.run("base", SCENE)
    width, cell = base.scene["domain"]["size"][0], base.scene["domain"]["cell"]
    mirrored = lab.run("mirrored", SCENE, *moved(base, lambda x: width - x))
    shifted = lab.run("shifted", SCENE, *moved(base, lambda x: x + cell))
    first = base.particles()
    return [limit(case, "mirrored: largest difference of T and P",
                  difference(first, mirrored.particles(), lambda i: SITES - 1 - i), 1e-12),
            limit(case, "shifted by one cell: largest difference of T and P",
                  difference(first, shifted.particles(), lambda i: (i + 2) % SITES), 1e-12)]
