"""A scene as a Python script with PyVista and nothing of a server in it, that makes the same picture."""

from __future__ import annotations

import builtins
import keyword
import re
import textwrap
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from pvfiblets.mappers.frames.scene import USUAL_DPI
from pvfiblets.plotting.slices.settings import MEANING
from pvfiblets.support.nifti_space import chosen
from pvfiblets.support.surface_space import tkras_chosen
from pvfiblets.web.scene import layers
from pvfiblets.web.scene.actors import split_cuts
from pvfiblets.web.scene.matrix import graph_looks
from pvfiblets.web.scene.slices.glyph_layers import GLYPHS
from pvfiblets.web.scene.slices.glyph_layers import arguments as glyph_arguments
from pvfiblets.web.scene.slices.slicing import image_looks
from pvfiblets.web.session.document import LINES, Clip, Layer, Matrix, Source, volumes_of
from pvfiblets.web.session.script_code import Python, code
from pvfiblets.web.session.script_slices import bundle_lines, has_images, image_arguments, painting_lines, slicing_lines
from pvfiblets.web.session.script_writer import ViewWriter, free_variable, names_in
from pvfiblets.web.session.shapes import condition_code, mesh_code, planes_of, shape_code, shapes_in

if TYPE_CHECKING:
    from pvfiblets.web.scene.scene import Scene

_LABELS = '''
def labels_of(path, labels):
    """Return the region of some labels of a volume."""
    image = as_image(path)
    return regions.Labels(image.labels, image.affine, labels=labels)
'''

_UNPACKED = '''
def unpacked(text):
    """Return whole numbers that are packed as bits, or as the lengths of gaps and runs in turns."""
    kind, data = text.split(":")
    data = base64.b64decode(data)
    if kind == "bits":
        return np.flatnonzero(np.unpackbits(np.frombuffer(data, np.uint8), bitorder="little"))
    ends = np.cumsum(np.frombuffer(data, f"<{kind}"), dtype=np.int64).reshape(-1, 2)
    return np.concatenate([np.arange(*run) for run in ends])
'''


def as_script(scene: Scene, picture: str | None = None) -> str:
    """Return a script that makes the picture of a scene."""
    shown = scene.state.layers
    draft = _Writer(scene, {layer.id: f"_{k}" for k, layer in enumerate(shown)}).write(picture)
    taken = {*dir(builtins), *keyword.kwlist, *keyword.softkwlist, *names_in(draft)}
    names: dict[str, str] = {}
    for layer in shown:  # a file print.tck is no function of the script
        names[layer.id] = free_variable(layer.name, taken)
        taken.add(names[layer.id])
    return _Writer(scene, names).write(picture)


class _Writer(ViewWriter):
    """Writes layers, their filters and cuts."""

    def write(self, picture: str | None) -> str:
        state = self._scene.state
        self._start(picture is not None)
        for layer in state.layers:
            self._layer(layer)
        for clip in state.clips:
            self._clip(clip)
        self._measurements()
        self._matrix()
        if state.painting is not None:
            self._imports |= {"import numpy as np", "from pvfiblets import regions"}
            self._lines += painting_lines(self._scene, self._names, self._ids)
        self._lines += slicing_lines(self._scene) if self._sliced else []
        self._bars()
        self._camera()
        end = "plotter.show()" if picture is None else f"plotter.screenshot({picture!r})\nplotter.close()"
        body = re.sub(r"\n{3,}", "\n\n", "\n".join([*self._lines, end]))
        if placing := self._placing():
            body = f"with {', '.join(placing)}:\n{textwrap.indent(body, '    ')}"
        return "\n".join([*self._head(), body]) + "\n"

    # Parts ----------------------------------------------------------------------------------------

    def _placing(self) -> list[str]:
        """Return the contexts that place images and surfaces as this process does."""
        found = []
        matrix, units = chosen()
        if matrix is not None or units != "mm":
            self._imports.add("import pvfiblets")
            given = [repr(matrix)] * (matrix is not None) + [f"units={units!r}"] * (units != "mm")
            found.append(f"pvfiblets.nifti_space({', '.join(given)})")
        if tkras_chosen():
            self._imports.add("from pvfiblets.support.surface_space import as_stored")
            found.append("as_stored()")
        return found

    def _head(self) -> list[str]:
        order = sorted(self._imports, key=lambda line: (line.split()[1].startswith("pvfiblets"), line.split()[1]))
        standard: list[str] = sorted({"import base64", "import dataclasses"} & self._imports)
        standard += ["from pathlib import Path"] if self._uses_folder else []
        standard += [""] if standard else []
        order = [line for line in order if line not in standard]
        found = ['"""Made by pvfiblets."""', "", *standard, *order, ""]
        if self._uses_folder:
            found += ['FOLDER = Path(".")  # where the files are', ""]
        for used, helper in ((self._uses_labels, _LABELS), (self._uses_packed, _UNPACKED)):
            found += [*helper.splitlines(), "", ""] if used else []
        return found

    def _start(self, off_screen: bool) -> None:
        width, height = self._plotter.window_size
        off = "off_screen=True, " if off_screen else ""
        sliced = has_images(self._scene)
        views = ", shape=(1, 5), border=False" if sliced else ""
        self._lines += [f"plotter = pv.Plotter({off}window_size=({width}, {height}){views})"]
        self._lines += ["plotter.subplot(0, 3)  # the 3-D view"] if sliced else []
        self._lines += [f"plotter.set_background({self._scene.state.background!r})"]
        window, renderer = self._plotter.render_window, self._plotter.renderer
        if (dpi := window.GetDPI()) != USUAL_DPI:
            self._lines += [f"plotter.render_window.SetDPI({dpi})  # letters as large as on the page"]
        if renderer.GetUseFXAA():
            self._lines += ["plotter.enable_anti_aliasing('fxaa')"]
        elif window is not None and window.GetMultiSamples() > 1:
            theme, samples = self._plotter.theme, window.GetMultiSamples()
            if theme.anti_aliasing not in (None, "msaa") or theme.multi_samples != samples:
                self._lines += [f"plotter.enable_anti_aliasing('msaa', multi_samples={samples})"]
        else:
            self._lines += ["plotter.disable_anti_aliasing()"]
        if renderer.GetUseDepthPeeling():
            self._lines += ["plotter.enable_depth_peeling()"]
        self._lines += [""]

    def _layer(self, layer: Layer) -> None:
        if layer.kind == "image":
            self._image(layer, image_looks(layer))
            return
        name, looks = self._names[layer.id], layers.looks(layer.kind, layer.settings)
        unsaid = layers.USUAL[layer.kind]
        if isinstance(looks.get("scalars"), Source):
            looks["scalars"] = self._colours(looks["scalars"])
        scale = looks.pop(layers.RADIUS_SCALE, 1.0)
        said = {key: value for key, value in looks.items() if key not in unsaid or unsaid[key] != value}
        arguments = {
            key: value for key, value in said.items() if layer.kind == "mesh" or key in layers.ARGUMENTS[layer.kind]
        }
        arguments["show_scalar_bar"] = False
        bundled = layer.kind in LINES and self._scene.state.bundles_of(layer.source) is not None
        late = arguments.pop("scalars", None) if bundled and arguments.get("scalars") == "group" else None
        if late is not None:
            del said["scalars"]  # of bundles that are not there yet
        method = {"tubes": "add_spline_tubes", "volume": "add_raycast_volume", "mesh": "add_mesh"}.get(
            layer.kind, "add_fiblets"
        )
        self._call(f"{name} = plotter.{method}", self._source(layer), arguments)
        self._lines += [f"{name}.{key} = {code(value)}" for key, value in said.items() if key not in arguments]
        if scale != 1.0:
            self._imports.add("import dataclasses")
            self._lines += [f"scaled = {{'radius': {scale} * {name}.tubes.radius,"]
            self._lines += [f"          'radius_slopes': {scale} * {name}.tubes.radius_slopes}}"]
            self._lines += [f"{name}.tubes = dataclasses.replace({name}.tubes, **scaled)"]
        if not layer.visible:
            self._lines += [f"{name}.visibility = False"]
        if layer.kind in LINES:
            if bundled:
                self._imports.add("import numpy as np")
                self._lines += bundle_lines(self._scene, layer, name, self._ids)
                self._lines += [f"{name}.scalars = {late!r}"] if late is not None else []
            self._filters(name, layer)
            self._selection(name, layer)
        self._lines += [""]

    def _image(self, layer: Layer, looks: Mapping[str, Any]) -> None:
        """Show an image as slices, in panes too; the first of them makes these."""
        name, usual, meaning = self._names[layer.id], layers.USUAL["image"], layer.settings[MEANING]
        said = {key: value for key, value in looks.items() if usual[key] != value}
        arguments = image_arguments(layer, meaning, self._file) | said
        if meaning == "direction" and (weights := volumes_of(layer.settings).get("modulate")) is not None:
            arguments["modulate"] = Python(self._image_source(replace(layer, source=weights)))
        if self._sliced:
            self._call(f"{name} = workspace.slices.add", self._image_source(layer), arguments)
        else:
            self._sliced = True
            arguments |= {"reset_camera": False}
            self._call("workspace = plotter.slices.workspace", self._image_source(layer), arguments)
            self._lines += [f"{name} = workspace.slices.layers[0]"]
        self._lines += [f"{name}.name = {layer.name!r}"]
        self._lines += [] if layer.visible else [f"{name}.visible = False"]
        if layer.settings[GLYPHS] is not None and layer.visible:
            shown = glyph_arguments(layer.settings)
            self._call("workspace.slices.add_glyphs", f"{name}.image", shown)
        self._lines += [""]

    def _image_source(self, layer: Layer) -> str:
        if layer.source.demo is not None:
            self._imports.add("from pvfiblets.synthetic.vessels import brain_like")
            return f"brain_like({layer.source.size})"
        return self._file(str(layer.source.path))

    def _source(self, layer: Layer) -> str:
        """Return Python of what a layer draws."""
        source = layer.source
        loaded = self._scene.data(layer)
        if source.values and layer.kind == "mesh":
            self._imports.add("from pvfiblets.plotting.gifti import with_vertex_values")
            mesh = self._mesh(str(source.path), source.space)
            for one in source.values:
                mesh = f"with_vertex_values({mesh}, {self._file(one)})"
            return mesh
        if source.values and source.ids is None:
            return self._whole(source, loaded.kept)
        if source.demo == "head":
            self._imports.add("from pvfiblets.synthetic.vessels import brain_like")
            return f"brain_like({source.size})"
        if source.ids is None and source.demo == "tracts":
            self._imports.add("from pvfiblets.synthetic import brain_streamlines")
            return f"brain_streamlines({source.size}, 0.5)"
        if source.ids is not None:
            return f"{self._whole(source, loaded.kept)}.extract({self._ids(source.ids.runs)})"
        assert source.path is not None
        path = self._file(source.path)
        if layer.kind == "mesh":
            return self._mesh(source.path, source.space)
        if layer.kind in (*LINES, "tubes") and source.space is not None:
            self._imports.add("import pvfiblets")
            path = f"pvfiblets.read({path}, space={source.space!r})"
        if layer.kind == "volume" and source.path.lower().endswith((".vtk", ".vtp")):
            return f"pv.read({path})"
        if layer.kind in LINES and loaded.kept:
            return f"{path}, per_point={list(loaded.kept)}"
        return path

    def _mesh(self, path: str, space: str | None = None) -> str:
        """Return Python that reads a surface."""
        self._imports.add("from pvfiblets.plotting.meshes import read_mesh")
        return mesh_code(path, self._file, space)

    def _colours(self, source: Source) -> Python:
        """Return Python of a volume that colours or filters lines, as :meth:`.Files.load` takes it."""
        if source.demo is not None:
            self._imports.add("from pvfiblets.synthetic.vessels import brain_like")
            self._lines += [f"volume = brain_like({source.size})"]
            return Python("(volume.values, volume.affine)")
        path = str(source.path)
        if path.lower().endswith((".vtk", ".vtp")):
            return Python(f"pv.read({self._file(path)})")
        return Python(self._file(path))

    def _whole(self, source: Source, kept: tuple[str, ...]) -> str:
        """Return the name of the fiblets that a selection is a part of; they are made where they are not yet."""
        whole = replace(source, ids=None)
        for layer in self._scene.state.layers:
            before = layer.kind == "tractogram" and layer.source == whole
            if before and any(line.startswith(f"{self._names[layer.id]} = ") for line in self._lines):
                return f"{self._names[layer.id]}.fiblets"
        if whole not in self._wholes:
            name = self._wholes[whole] = self._variable("fiblets")
            self._imports.add("import pvfiblets")
            keep = f", per_point={list(kept)}" if kept else ""
            if source.demo is not None:
                self._imports.add("from pvfiblets.synthetic import brain_streamlines")
                made = f"pvfiblets.compress(brain_streamlines({source.size}, 0.5))"
            elif str(source.path).lower().endswith(".fiblets"):
                made = f"pvfiblets.FibletSet.open({self._file(str(source.path))})"
            else:
                space = f", space={source.space!r}" if source.space is not None else ""
                made = f"pvfiblets.compress(pvfiblets.read({self._file(str(source.path))}{space}){keep})"
            self._lines += [f"{name} = {made}"]
            if source.values:
                self._imports.add("from pvfiblets.plotting.fiblets.along import with_table_of")
            self._lines += [f"{name} = with_table_of({name}, {self._file(path)})" for path in source.values]
        return self._wholes[whole]

    def _filters(self, name: str, layer: Layer) -> None:
        filters = layer.filters
        for criterion, (low, high) in filters.criteria.items():
            image = filters.images.get(criterion)
            values = criterion if image is None else self._colours(image)
            self._lines += [f"{name}.criterion({code(values)}, ({code(low)}, {code(high)}))"]
        if filters.groups is not None:
            self._lines += [f"{name}.groups_shown = {list(filters.groups)}"]
        if filters.subset is not None:
            self._lines += [f"{name}.subset({', '.join(f'{k}={v!r}' for k, v in filters.subset.items())})"]
        if filters.regions is not None:
            for shape in shapes_in(filters.regions):
                self._needs(shape)
            self._imports.add("from pvfiblets import regions")
            self._lines += [f"{name}.include({condition_code(filters.regions, self._file)})"]
        if filters.connection is not None:
            self._imports |= {"import numpy as np", "from pvfiblets.query.connectome.matrix import end_labels"}
            parcels = self._parcels(filters.connection["labels"])
            radius, pair = filters.connection["radius"], filters.connection["pair"]
            self._lines += [
                f"ends = np.sort(end_labels({name}.fiblets, {parcels}, {radius}), axis=1)",
                f"{name}.include((ends == {pair}).all(axis=1))  # between two parcels",
            ]

    def _parcels(self, path: str) -> str:
        """Return Python of a label volume's numbers and where they lie."""
        self._imports.add("from pvfiblets.images.sources import as_image")
        name = self._volumes.get(path)
        if name is None:
            name = self._volumes[path] = self._variable("parcels")
            self._lines += [f"{name} = as_image({self._file(path)})"]
        return name

    def _matrix(self) -> None:
        matrix = self._scene.state.matrix
        if matrix is None:
            return
        self._imports.add("import pvfiblets")
        given: dict[str, Any] = {
            name: getattr(matrix, name) for name in ("weights", "contrast", "statistic")
            if getattr(matrix, name) != getattr(Matrix, name)
        }  # fmt: skip
        given["radius"] = matrix.radius
        if matrix.names is not None:
            self._imports.add("from pvfiblets.slices.labels import as_label_table")
            given["names"] = Python(f"as_label_table({self._file(matrix.names)}).names")
        parcels = self._parcels(matrix.labels)
        self._call("matrix = pvfiblets.connectome", f"{self._names[matrix.layer]}.fiblets", parcels, given)
        self._lines += ["print(matrix)  # matrix.matrix has the numbers; matrix.save writes them"]
        found = self._scene.matrix.connectome(self._scene.state)
        if matrix.graph and found is not None:
            looks = {**graph_looks(found, matrix), "show_scalar_bar": False, "reset_camera": False}
            self._call("graph = plotter.add_connectome", "matrix", parcels, looks)
            if cell := self._scene.matrix.cell(self._scene.state):
                self._imports.add("import numpy as np")
                self._lines += [f"graph.edge_actor.select((graph.pairs == {sorted(cell)}).all(axis=1))"]
        self._lines += [""]

    def _selection(self, name: str, layer: Layer) -> None:
        if layer.selected is None:
            return
        usual = layers.defaults(layer.kind)
        style = {
            theirs: layer.settings[ours]
            for ours, theirs in layers.SELECTION.items()
            if layer.settings[ours] != usual[ours]
        }
        if style:
            self._lines += [f"{name}.selection_style({', '.join(f'{k}={v!r}' for k, v in style.items())})"]
        self._lines += [f"{name}.select({self._ids(layer.selected.runs)})"]

    def _clip(self, clip: Clip) -> None:
        cut = [layer for layer in self._scene.state.layers if clip.cuts(layer)]
        for layer in cut:
            if layer.kind not in (*LINES, "volume"):
                self._cut_surface(layer, clip)
        names = [self._names[layer.id] for layer in cut if layer.kind in (*LINES, "volume")]
        if not names:
            return
        if clip.shape["kind"] == "mesh":
            region = self._mesh(clip.shape["path"], clip.shape.get("space"))
        else:
            self._needs(clip.shape)
            region = shape_code(clip.shape, self._file)
        inside = "" if clip.inside else ", inside=False"
        if len(names) == 1:
            self._lines += [f"{names[0]}.clip({region}{inside})", ""]
            return
        self._lines += [
            f"region = {region}",
            f"for actor in ({', '.join(names)}):",
            f"    actor.clip(region{inside})",
            "",
        ]

    def _cut_surface(self, layer: Layer, clip: Clip) -> None:
        """Cut tubes or a mesh by one clip, as the scene does."""
        name = self._names[layer.id]
        _, others = split_cuts(layer, [other for other in self._scene.state.clips if other.cuts(layer)])
        if clip in others:
            self._needs(clip.shape)
            self._imports.add("from pvfiblets.plotting.cut_surfaces import cut_surface")
            side = "" if clip.inside else "~"
            region = f"{side}{shape_code(clip.shape, self._file)}"
            self._lines += [f"{name}.mapper.dataset = cut_surface({name}.mapper.dataset, {region})", ""]
            return
        self._imports.add("from vtkmodules.vtkCommonDataModel import vtkPlane")
        for normal, origin in planes_of(clip.shape, clip.inside) or []:
            self._lines += ["plane = vtkPlane()", f"plane.SetNormal({normal})", f"plane.SetOrigin({origin})"]
            self._lines += [f"{name}.mapper.AddClippingPlane(plane)", ""]

    def _needs(self, shape: Mapping[str, Any]) -> None:
        """Import what the Python of a shape uses."""
        if shape["kind"] not in ("mesh", "labels"):
            self._imports.add("from pvfiblets import regions")
        elif shape["kind"] == "mesh" or shape["labels"] is None:
            self._imports.add("from pvfiblets.plotting.filtering.region_sources import as_region")
            if shape["kind"] == "mesh":
                self._mesh(shape["path"])
        else:
            self._imports |= {"from pvfiblets import regions", "from pvfiblets.images.sources import as_image"}
            self._uses_labels = True
