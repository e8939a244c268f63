#pragma once

// ITK brings an older copy of Eigen under the same include guards: the program's own must come first and
// whole. Include this header before any other of ITK. Internal to segmentation.

#include <Eigen/Core>
#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

// clang-format off
#include <itkImage.h>
#include <itkImageIOBase.h>
#include <itkMetaDataObject.h>
// clang-format on
