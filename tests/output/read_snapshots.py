"""Reads the snapshots of a folder with h5py and checks snapshots.xdmf against them."""
import sys
import xml.etree.ElementTree as xml

import h5py
import numpy

folder = sys.argv[1]
units = {"id": "1", "grain": "1", "material": "1", "position": "m", "velocity": "m/s",
         "mass": "kg/m", "density": "kg/m^3", "pressure": "Pa", "stress": "Pa",
         "temperature": "K", "plastic_strain": "1", "plastic_work": "J/kg",
         "internal_energy": "J/kg", "kinetic_energy": "J/kg"}

with h5py.File(f"{folder}/snapshot_000003.h5") as file:
    assert file.userblock_size == 4096
    assert file.attrs["time"] == 1.5e-8 and file.attrs["step"] == 300
    assert file.attrs["record"] == 3 and file.attrs["dimension"] == 2
    assert file.attrs["thermal"] == "conserving" and file.attrs["kind"] == "snapshot"
    assert file.attrs["scene"] == 'title = "snapshot"\n'
    assert file.attrs["version"] and file.attrs["revision"]
    particles = file["particles"]
    assert {name: data.attrs["unit"] for name, data in particles.items()} == units
    rows = numpy.arange(13)
    assert particles["id"].dtype == numpy.int64
    assert (particles["id"][:] == 7919 * rows + 2**40).all()
    assert particles["grain"].dtype == numpy.int32 and (particles["grain"][:] == rows - 5).all()
    assert particles["position"].shape == (13, 2) and particles["stress"].shape == (13, 4)
    assert (particles["position"][:, 1] == 0.125 * rows + 0.75).all()
    assert (particles["pressure"][:] == 1e6 * rows).all()
    assert (particles["stress"][:, 3] == 4e5 + rows).all()
    assert particles["temperature"][0] > 299 and numpy.isfinite(particles["temperature"][:]).all()

root = xml.parse(f"{folder}/snapshots.xdmf").getroot()
series = root.find("Domain/Grid")
assert series.get("CollectionType") == "Temporal"
grids = series.findall("Grid")
assert [float(g.find("Time").get("Value")) for g in grids] == [0.0, 1.5e-8, 0.1]
for grid in grids:
    assert grid.find("Topology").get("TopologyType") == "Polyvertex"
    assert grid.find("Topology").get("NumberOfElements") == "13"
    assert grid.find("Geometry").get("GeometryType") == "XY"
    assert {a.get("Name") for a in grid.findall("Attribute")} == set(units) - {"position"} | {"owner"}
    for item in grid.iter("DataItem"):
        name, path = item.text.split(":")
        with h5py.File(f"{folder}/{name}") as file:
            data = file[path]
            assert tuple(int(n) for n in item.get("Dimensions").split()) == data.shape
            assert int(item.get("Precision")) == data.dtype.itemsize
            kind = {"f": "Float", "i": "Int"}[data.dtype.kind]
            assert item.get("NumberType") == kind
