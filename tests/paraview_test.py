"""fields.xdmf as ParaView's readers see it. In the environment: PROGRAM, WORK, and DISPLAY, as xvfb-run sets it."""

import json
import os
import shutil
import subprocess
import unittest
from pathlib import Path
from xml.etree import ElementTree

import h5py
import numpy as np
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  draws; vtkRenderingCore alone has no pixels
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkFiltersCore import vtkFeatureEdges, vtkMassProperties
from vtkmodules.vtkIOXdmf2 import vtkXdmfReader
from vtkmodules.vtkIOXdmf3 import vtkXdmf3Reader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
from vtkmodules.vtkRenderingCore import vtkActor, vtkDataSetMapper, vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter

ROOT = Path(__file__).resolve().parent.parent
WORK = Path(os.environ["WORK"])
SCENES = {
    "dam_break": {"/time/end": 0.2, "/time/step": 0.01, "/output/every": 0.05},
    "dam_break_3d": {"/grid/cells": [16, 8, 16], "/particles/0/per_cell": 2, "/time/end": 0.2, "/time/step": 0.02,
                     "/output/every": 0.1, "/output/surface": "vtp"},
}
BODIES = {"/time/end": 0.2, "/grid/cells": [20, 20], "/time/step": 0.01, "/output/every": 0.1}  # of the mixer
READERS = (vtkXdmfReader, vtkXdmf3Reader)  # ParaView offers both: "XDMF Reader" and "Xdmf3 Reader"
WHITE = 255


def opened(kind, scene):
    reader = kind()
    reader.SetFileName(str(WORK / scene / "fields.xdmf"))
    reader.UpdateInformation()
    return reader


def times_of(reader):
    return list(reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS()))


def at(reader, time):
    """The particles at a time."""
    reader.UpdateTimeStep(time)
    return reader.GetOutputDataObject(0)


def column(particles, name):
    return vtk_to_numpy(particles.GetPointData().GetArray(name))


def picture(scene, time):
    """The particles coloured by pressure on white, as pixels."""
    reader = opened(vtkXdmf3Reader, scene)
    mapper = vtkDataSetMapper()
    mapper.SetInputData(at(reader, time))
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("pressure")
    mapper.SetScalarRange(0, 1500)  # [Pa], half the weight of the column of 0.292 m
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetPointSize(3)
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(actor)
    renderer.ResetCamera()
    window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetSize(200, 200)
    window.SetMultiSamples(0)
    window.AddRenderer(renderer)
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.Update()
    return vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars())


class ParaView(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        for scene, settings in (SCENES | {"mixer": BODIES}).items():
            command = [os.environ["PROGRAM"], "run", str(ROOT / f"scenes/{scene}.json"), "--out", str(WORK / scene)]
            for key, value in settings.items():
                command += ["--set", f"{key}={json.dumps(value)}"]
            subprocess.run([*command, "--threads", "1", "--quiet"], check=True)

    def test_a_reader_finds_every_frame_at_its_time(self):
        for kind in READERS:
            for scene, frames in (("dam_break", 5), ("dam_break_3d", 3)):
                with self.subTest(reader=kind.__name__, scene=scene), h5py.File(WORK / scene / "fields.h5") as file:
                    groups = file["particles"]
                    self.assertEqual(len(groups), frames)
                    expected = [groups[str(k)].attrs["time"] for k in range(frames)]
                    self.assertEqual(times_of(opened(kind, scene)), expected)

    def test_particles_have_the_places_and_values_of_fields_h5(self):
        for kind in READERS:
            for scene in SCENES:
                reader = opened(kind, scene)
                with h5py.File(WORK / scene / "fields.h5") as file:
                    for k, time in enumerate(times_of(reader)):
                        with self.subTest(reader=kind.__name__, scene=scene, time=time):
                            self.compare(at(reader, time), file[f"particles/{k}"])

    def compare(self, particles, group):
        position = group["position"][:]
        dimension = position.shape[1]
        self.assertEqual(particles.GetNumberOfCells(), len(position))  # a vertex each, without which nothing is drawn
        points = vtk_to_numpy(particles.GetPoints().GetData())
        np.testing.assert_array_equal(points[:, :dimension], position)
        self.assertFalse(points[:, dimension:].any())
        for name in ("velocity", "pressure", "id", "velocity_gradient"):
            np.testing.assert_array_equal(column(particles, name), group[name][:], err_msg=name)

    def test_bodies_stand_beside_the_particles_where_fields_h5_has_them(self):
        for kind in READERS:
            reader = opened(kind, "mixer")
            with h5py.File(WORK / "mixer/fields.h5") as file:
                for k, time in enumerate(times_of(reader)):
                    with self.subTest(reader=kind.__name__, time=time):
                        frame = at(reader, time)
                        self.assertEqual(frame.GetNumberOfBlocks(), 2)
                        self.compare(frame.GetBlock(0), file[f"particles/{k}"])
                        cross = frame.GetBlock(1)
                        self.assertTrue(frame.GetMetaData(1).Get(frame.NAME()).startswith("cross"))
                        self.assertEqual(cross.GetNumberOfCells(), 12)
                        points = vtk_to_numpy(cross.GetPoints().GetData())[:, :2]
                        np.testing.assert_array_equal(points, file[f"bodies/{k}/cross/points"][:])

    def test_the_surfaces_of_the_index_are_closed_and_hold_the_liquid(self):
        folder = WORK / "dam_break_3d"
        sets = ElementTree.parse(folder / "surface.pvd").getroot().findall("Collection/DataSet")
        self.assertEqual([float(one.get("timestep")) for one in sets], times_of(opened(vtkXdmf3Reader, "dam_break_3d")))
        for one in sets:
            with self.subTest(file=one.get("file")):
                reader = vtkXMLPolyDataReader()
                reader.SetFileName(str(folder / one.get("file")))
                reader.Update()
                surface = reader.GetOutput()
                self.assertGreater(surface.GetNumberOfPolys(), 1000)
                self.assertEqual(column(surface, "velocity").shape, (surface.GetNumberOfPoints(), 3))
                self.assertTrue(np.isfinite(column(surface, "velocity")).all())
                edges = vtkFeatureEdges()
                edges.SetInputData(surface)
                edges.FeatureEdgesOff()  # leaves those of one triangle, and of more than two
                edges.Update()
                self.assertEqual(edges.GetOutput().GetNumberOfCells(), 0)
                inside = vtkMassProperties()
                inside.SetInputData(surface)
                self.assertAlmostEqual(inside.GetVolume() / (0.146 * 0.146 * 0.292), 1, delta=0.01)

    def test_the_particles_can_be_seen(self):
        for scene in SCENES:
            with self.subTest(scene=scene):
                start, end = (picture(scene, time) for time in (0.0, 0.2))
                drawn = (end != WHITE).any(axis=1).mean()
                self.assertGreater(drawn, 0.03)
                self.assertLess(drawn, 0.9)
                self.assertGreater(len(np.unique(end, axis=0)), 20)  # colours: the pressure varies
                self.assertGreater((start != end).any(axis=1).mean(), 0.03)  # the liquid has moved


if __name__ == "__main__":
    unittest.main()
