"""The view of the paper in ParaView: pvpython tools/paraview_view.py RUN [--time NS] [--field temperature]
[--low 300 --high 900] [--slabs] [--output picture.png]. Without --output a picture lies beside the snapshots.

The particles of one time, coloured by a field from blue to red as in the paper's figures, inside the outline
of the grid; with --slabs coloured by the rank that owns them, with the edges of the slabs.
"""
import argparse
import glob
import os
import tomllib

import h5py
import numpy
from paraview import simple
from paraview.servermanager import Fetch
from vtkmodules.numpy_interface import dataset_adapter

LIMITS = {"temperature": (300.0, 900.0)}


def options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", help="output folder, or its snapshots.xdmf")
    parser.add_argument("--time", type=float, help="ns; by default the last snapshot")
    parser.add_argument("--field", default="temperature")
    parser.add_argument("--low", type=float, help="of the colours, in the unit of the field")
    parser.add_argument("--high", type=float)
    parser.add_argument("--slabs", action="store_true", help="colour by the owning rank instead")
    parser.add_argument("--height", type=int, default=1200, help="of the picture, pixels")
    parser.add_argument("--output")
    return parser.parse_args()


def read(run):
    """The series of snapshots and its times, s."""
    path = run if run.endswith(".xdmf") else os.path.join(run, "snapshots.xdmf")
    if not os.path.isfile(path):
        raise SystemExit(f"paraview_view: there is no {path}; give the output folder of a run")
    reader = simple.XDMFReader(FileNames=[path])
    reader.UpdatePipelineInformation()
    return reader, list(reader.TimestepValues)


def values_of(reader, time):
    """Positions, fields and spacing of the particles at a time."""
    reader.UpdatePipeline(time)
    data = dataset_adapter.WrapDataObject(Fetch(reader))
    # Squares that touch in a map of the undeformed solid; the samples are about half dense in the end.
    points = numpy.asarray(data.Points)
    extent = numpy.ptp(points, axis=0)
    spacing = float(numpy.sqrt(max(extent[0], 1e-30) * max(extent[1], 1e-30) / len(points)))
    return points, data.PointData, spacing


def grid_corners(folder, time):
    """Low and high corner of the background grid at a time; it rides with a moving wall."""
    for path in glob.glob(os.path.join(folder, "snapshot_*.h5")):
        with h5py.File(path) as file:
            if file.attrs["time"] != time:
                continue
            size = tomllib.loads(file.attrs["scene"])["domain"]["size"]
            low = numpy.array([file.attrs["origin_" + axis] for axis in "xyz"[:len(size)]] + [0.0] * (3 - len(size)))
            return low, low + numpy.array(list(size) + [0.0] * (3 - len(size)))
    raise SystemExit(f"paraview_view: no snapshot in {folder} is of {time} s")


def outline(low, high):
    """The edges of the background grid."""
    box = simple.Box(XLength=high[0] - low[0], YLength=high[1] - low[1], ZLength=high[2] - low[2],
                     Center=[float(x) for x in 0.5 * (low + high)])
    shown = simple.Show(box)
    shown.Representation = "Outline"
    shown.AmbientColor = shown.DiffuseColor = [0.0, 0.0, 0.0]


def slab_edges(points, owner):
    """Lines across the sample where one rank ends and the next begins."""
    low, high = points.min(axis=0), points.max(axis=0)
    axis = 2 if high[2] > low[2] else 1
    for rank in sorted(set(owner.tolist()))[1:]:
        edge = 0.5 * (points[owner == rank, axis].min() + points[owner < rank, axis].max())
        ends = [low.copy(), high.copy()]
        for end in ends:
            end[axis] = edge
        line = simple.Show(simple.Line(Point1=[float(x) for x in ends[0]], Point2=[float(x) for x in ends[1]]))
        line.AmbientColor = line.DiffuseColor = [0.0, 0.0, 0.0]
        line.LineWidth = 2.0


def colour(particles, name, low, high, preset, title):
    simple.ColorBy(particles, ("POINTS", name))
    table = simple.GetColorTransferFunction(name)
    table.ApplyPreset(preset, True)
    table.RescaleTransferFunction(low, high)
    bar = simple.GetScalarBar(table, simple.GetActiveView())
    bar.Title, bar.ComponentTitle = title, ""
    bar.TitleColor = bar.LabelColor = [0.0, 0.0, 0.0]
    bar.WindowLocation = "Any Location"
    bar.Position, bar.ScalarBarLength = [0.8, 0.25], 0.5
    bar.Visibility = 1


def draw(choice):
    reader, times = read(choice.run)
    time = times[-1] if choice.time is None else min(times, key=lambda t: abs(t - choice.time * 1e-9))
    folder = os.path.dirname(choice.run) if choice.run.endswith(".xdmf") else choice.run
    points, fields, spacing = values_of(reader, time)
    corners = grid_corners(folder, time)
    name = "owner" if choice.slabs else choice.field
    if name not in fields.keys():
        raise SystemExit(f"paraview_view: no field {name}; the snapshot holds {', '.join(sorted(fields.keys()))}")
    values = numpy.asarray(fields[name])
    extent = numpy.ptp(points, axis=0)
    flat = extent[2] == 0.0
    height = (corners[1] - corners[0])[1 if flat else 2]
    width = int(choice.height * max(0.45, min(2.0, 1.1 * extent[0] / height + 0.3)))
    view = simple.CreateRenderView(ViewSize=[width, choice.height], OrientationAxesVisibility=0)
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    simple.SetActiveView(view)
    view.ViewTime = time
    particles = simple.Show(reader, view)
    particles.Representation = "Point Gaussian"
    particles.GaussianRadius = 0.75 * spacing
    particles.ShaderPreset = "Plain circle"
    low, high = LIMITS.get(name, (float(values.min()), float(values.max())))
    low = choice.low if choice.low is not None else low
    high = choice.high if choice.high is not None else high
    colour(particles, name, low, max(high, low + 1e-30), "Viridis (matplotlib)" if choice.slabs else "Jet",
           "rank" if choice.slabs else name)
    outline(*corners)
    if choice.slabs:
        slab_edges(points, values)
    simple.ResetCamera()
    if flat:
        view.CameraParallelProjection = 1
        view.CameraParallelScale = 0.53 * height
    simple.Render(view)
    target = choice.output or os.path.join(folder, f"paraview_{name}.png")
    simple.SaveScreenshot(target, view)
    print(f"{target}: {len(points)} particles at {time * 1e9:.6g} ns, {name} {values.min():.6g} ... {values.max():.6g}; "
          f"{len(times)} times")


if __name__ == "__main__":
    draw(options())
