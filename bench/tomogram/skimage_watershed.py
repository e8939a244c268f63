"""Beads of a tomogram the usual way in scikit-image: Otsu's threshold, distance map, its maxima as markers,
watershed, moments of the labels.

  skimage_watershed.py VOLUME.mha OUT.csv X_UM Y_UM RADIUS_UM BOTTOM_UM TOP_UM

The container is given, since the watershed does not know of one.
"""

import sys

import numpy as np
from scipy import ndimage
from skimage.feature import peak_local_max
from skimage.filters import threshold_otsu
from skimage.measure import regionprops_table
from skimage.segmentation import watershed


def read_mha(path):
    header = {}
    with open(path, "rb") as file:
        while "ElementDataFile" not in header:
            key, _, value = file.readline().decode().partition("=")
            header[key.strip()] = value.strip()
        begin = file.tell()
    size = [int(n) for n in header["DimSize"].split()]
    numbers = lambda key: np.array([float(n) for n in header[key].split()])
    return np.memmap(path, np.uint16, "r", begin, tuple(size[::-1])), numbers("Offset"), numbers("ElementSpacing")[0]


def main():
    path, out = sys.argv[1:3]
    x, y, radius, bottom, top = map(float, sys.argv[3:8])
    grey, origin, voxel = read_mha(path)
    along = [origin[axis] + voxel * np.arange(grey.shape[2 - axis]) for axis in range(3)]
    beads = grey > threshold_otsu(grey)
    beads &= np.hypot(along[0][None, :] - x, along[1][:, None] - y) < radius
    beads &= ((along[2] > bottom) & (along[2] < top))[:, None, None]
    distance = ndimage.distance_transform_edt(beads).astype(np.float32)
    typical = distance.max()
    markers = np.zeros(beads.shape, np.int32)
    peaks = peak_local_max(distance, min_distance=int(0.5 * typical), exclude_border=False)
    markers[tuple(peaks.T)] = np.arange(1, len(peaks) + 1)
    labels = watershed(-distance, markers, mask=beads)
    table = regionprops_table(labels, properties=("centroid", "area"))
    with open(out, "w") as file:
        file.write("x_um,y_um,z_um,diameter_um\n")
        for z, y, x, volume in zip(table["centroid-0"], table["centroid-1"], table["centroid-2"], table["area"]):
            centre = origin + voxel * np.array([x, y, z])
            file.write("%.4f,%.4f,%.4f,%.4f\n" % (*centre, voxel * (6 * volume / np.pi) ** (1 / 3)))


main()
