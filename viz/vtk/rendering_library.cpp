#include "viz/vtk/pictures.h"

const pendular::viz::Rendering pendular_rendering = {
    pendular::viz::scene_picture, pendular::viz::bead_map_pictures, pendular::viz::write_png_file,
    pendular::viz::jpeg_thumbnail};
