"""The same with grains in contact."""
from test_interrupted import LONG, Interrupted as OneBody

# Grains that meet, rub and lie across slabs; some touch from the start.
GRAINS = (LONG.replace('kind = "random_voids"', 'kind = "packed_grains"').replace("porosity = 0.15", "porosity = 0.3")
          .replace("void_radius = 25e-6", "grain_radius = 25e-6\ngrain_spread = 0.2")
          .replace("[conduction]", "[contact]\nfriction = 0.3\n[conduction]"))


class InterruptedGrains(OneBody):
    text = GRAINS
    sample = " of grains in contact"


del OneBody  # only the grains here
