"""The view of the paper in ParaView: pvpython tools/paraview_view.py RUN [--time NS] [--field temperature]
[--low 300 --high 900] [--slabs] [--surface 900] [--slices 0.1 0.2] [--output picture.png]. Without --output a picture
lies beside the snapshots.

The particles of one time, coloured by a field from dark to light as in the paper's figures, inside the outline
of the grid; with --slabs coloured by the rank that owns them, with the edges of the slabs. In three dimensions --surface
shows where the map of the field reaches a value, and --slices the map at heights in mm instead of the particles.
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
HEAT = "Inferno (matplotlib)"  # lightness rises with the value, for all eyes


def options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", help="output folder, or its snapshots.xdmf")
    parser.add_argument("--time", type=float, help="ns; by default the last snapshot")
    parser.add_argument("--field", default="temperature")
    parser.add_argument("--low", type=float, help="of the colours, in the unit of the field")
    parser.add_argument("--high", type=float)
    parser.add_argument("--slabs", action="store_true", help="colour by the owning rank instead")
    parser.add_argument("--surface", type=float, help="3-D: value of the field whose surface is shown, in its unit")
    parser.add_argument("--slices", type=float, nargs="+", help="3-D: heights of slices across the shock axis, mm")
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
    extent = extent[extent > 0.0]
    spacing = float(numpy.prod(extent) / len(points))**(1.0 / len(extent))
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


def colour(shown, kind, name, limits, preset, title):
    """Colours what is shown by a field of its points or cells, with a bar."""
    simple.ColorBy(shown, (kind, name))
    table = simple.GetColorTransferFunction(name)
    table.ApplyPreset(preset, True)
    table.RescaleTransferFunction(limits[0], max(limits[1], limits[0] + 1e-30))
    bar = simple.GetScalarBar(table, simple.GetActiveView())
    bar.Title, bar.ComponentTitle = title, ""
    bar.TitleColor = bar.LabelColor = [0.0, 0.0, 0.0]
    bar.WindowLocation = "Any Location"
    bar.Position, bar.ScalarBarLength = [0.8, 0.25], 0.5
    bar.Visibility = 1


def show_particles(reader, spacing, name, limits, slabs):
    """Discs at the particles."""
    particles = simple.Show(reader)
    particles.Representation = "Point Gaussian"
    particles.GaussianRadius = 0.75 * spacing
    particles.ShaderPreset = "Plain circle"
    preset, title = ("Viridis (matplotlib)", "rank") if slabs else (HEAT, name)
    colour(particles, "POINTS", name, limits, preset, title)


def read_map(folder, name, time, empty):
    """The voxels of a field, `empty` where there is no material; they are measured, not made from the particles."""
    path = os.path.join(folder, "maps.xdmf")
    if not os.path.isfile(path):
        raise SystemExit(f"paraview_view: there is no {path}; surfaces and slices need [morphology] in the scene")
    voxels = simple.XDMFReader(FileNames=[path])
    voxels.UpdatePipeline(time)
    if name not in voxels.CellData.keys():
        raise SystemExit(f"paraview_view: no map of {name}; there are maps of {', '.join(sorted(voxels.CellData.keys()))}")
    return simple.PythonCalculator(Input=voxels, ArrayAssociation="Cell Data", ArrayName=name,
                                   Expression=f"where(isnan({name}), {empty!r}, {name})")


def show_surface(voxels, name, level):
    """The surface at a level, in one colour."""
    contour = simple.Contour(Input=simple.CellDatatoPointData(Input=voxels), ContourBy=["POINTS", name], Isosurfaces=[level])
    shown = simple.Show(contour)
    simple.ColorBy(shown, None)
    shown.DiffuseColor = [0.84, 0.37, 0.0]


def show_slices(voxels, name, heights, limits):
    """The voxels on planes across the shock axis."""
    for height in heights:
        cut = simple.Slice(Input=voxels, SliceType="Plane")
        cut.SliceType.Origin, cut.SliceType.Normal = [0.0, 0.0, height], [0.0, 0.0, 1.0]
        shown = simple.Show(cut)
        shown.Representation = "Surface"
        colour(shown, "CELLS", name, limits, HEAT, name)


def make_view(extent, height, pixels, time):
    """A white view at a time, of a shape that suits the grid."""
    width = int(pixels * max(0.45, min(2.0, 1.1 * extent[0] / height + 0.3)))
    view = simple.CreateRenderView(ViewSize=[width, pixels], OrientationAxesVisibility=0)
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    simple.SetActiveView(view)
    view.ViewTime = time
    return view


def place_camera(view, flat, height):
    """Straight on in 2-D; in 3-D from the side and a little above."""
    if not flat:
        view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [0.57, -0.78, 0.32], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0]
    simple.ResetCamera()
    if flat:
        view.CameraParallelProjection = 1
        view.CameraParallelScale = 0.53 * height
    simple.Render(view)


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
    if flat and (choice.surface is not None or choice.slices):
        raise SystemExit("paraview_view: --surface and --slices are for runs in three dimensions")
    limits = [given if given is not None else usual for given, usual in
              zip((choice.low, choice.high), LIMITS.get(name, (float(values.min()), float(values.max()))))]
    height = (corners[1] - corners[0])[1 if flat else 2]
    view = make_view(extent, height, choice.height, time)
    if choice.surface is not None or choice.slices:
        voxels = read_map(folder, name, time, float(values.min()))
        if choice.surface is not None:
            show_surface(voxels, name, choice.surface)
        show_slices(voxels, name, [1e-3 * height for height in choice.slices or []], limits)
    else:
        show_particles(reader, spacing, name, limits, choice.slabs)
    outline(*corners)
    if choice.slabs:
        slab_edges(points, values)
    place_camera(view, flat, height)
    target = choice.output or os.path.join(folder, f"paraview_{name}.png")
    simple.SaveScreenshot(target, view)
    print(f"{target}: {len(points)} particles at {time * 1e9:.6g} ns, {name} {values.min():.6g} ... {values.max():.6g}; "
          f"{len(times)} times")


if __name__ == "__main__":
    draw(options())
