#include "viz/vtk/pictures.h"

const pendular::viz::Rendering pendular_rendering = {
    pendular::viz::scene_pictures, pendular::viz::bead_map_pictures, pendular::viz::write_png_file,
    pendular::viz::jpeg_thumbnail};
