#!/usr/bin/env python3
"""What VTK takes for the stages: vtk_stages.py VOLUME.raw SIZE MESH.ply [RUNS]. Prints a JSON object of seconds of a
core by stage, the least of some runs, one thread."""
import json, sys, time

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkObject, vtkSMPTools
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D, vtkPolyDataConnectivityFilter
from vtkmodules.vtkFiltersGeneral import vtkCurvatures
from vtkmodules.vtkImagingCore import vtkImageShrink3D
from vtkmodules.vtkImagingGeneral import vtkImageGaussianSmooth
from vtkmodules.vtkIOPLY import vtkPLYReader, vtkPLYWriter

volume, size, mesh, runs = sys.argv[1], int(sys.argv[2]), sys.argv[3], int(sys.argv[4]) if len(sys.argv) > 4 else 3
vtkSMPTools.SetBackend("Sequential")
vtkObject.GlobalWarningDisplayOff()  # a line for each vertex whose curvature it doubts


def least(make):
    """A new filter each time: a filter that has run does nothing."""
    best = float("inf")
    for _ in range(runs):
        step = make()
        before = time.process_time()
        step()
        best = min(best, time.process_time() - before)
    return best


voxels = numpy.fromfile(volume, dtype=numpy.float32)
image = vtkImageData()
image.SetDimensions(size, size, size)
image.GetPointData().SetScalars(numpy_to_vtk(voxels, deep=False))


def resample():
    gauss = vtkImageGaussianSmooth()
    gauss.SetInputData(image)
    gauss.SetDimensionality(3)
    gauss.SetStandardDeviation(0.85)
    gauss.SetRadiusFactor(1.2)
    shrink = vtkImageShrink3D()
    shrink.SetInputConnection(gauss.GetOutputPort())
    shrink.SetShrinkFactors(2, 2, 2)
    shrink.AveragingOff()
    for step in (gauss, shrink):
        step.SetEnableSMP(True)
    return shrink.Update


def extract():
    edges = vtkFlyingEdges3D()
    edges.SetInputData(image)
    edges.SetValue(0, 0.0)
    edges.ComputeNormalsOff()
    edges.ComputeGradientsOff()
    edges.ComputeScalarsOff()
    extract.last = edges
    return edges.Update


out = {"resample": least(resample), "extract": least(extract)}
found = extract.last.GetOutput()
out["triangles"] = found.GetNumberOfPolys()
reader = vtkPLYReader()
reader.SetFileName(mesh)
reader.Update()
surface = reader.GetOutput()


def curvature():
    """The smaller and the larger one take a filter each."""
    steps = []
    for name in ("SetCurvatureTypeToMinimum", "SetCurvatureTypeToMaximum"):
        step = vtkCurvatures()
        step.SetInputData(surface)
        getattr(step, name)()
        steps.append(step)
    return lambda: [step.Update() for step in steps]


def components():
    step = vtkPolyDataConnectivityFilter()
    step.SetInputData(surface)
    step.SetExtractionModeToAllRegions()
    step.ColorRegionsOn()
    return step.Update


def write():
    step = vtkPLYWriter()
    step.SetInputData(surface)
    step.SetFileName(mesh + ".vtk.ply")
    return step.Write


out["curvature"] = least(curvature)
out["components"] = least(components)
out["write PLY"] = least(write)
print(json.dumps(out))
