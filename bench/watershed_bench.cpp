// Beads of a tomogram by ITK's own watershed: Otsu's threshold, distance map, morphological watershed,
// moments of the labels.
//
//   watershed_bench VOLUME OUT.csv X_UM Y_UM RADIUS_UM BOTTOM_UM TOP_UM
//
// The container is given, since the watershed does not know of one.

#include <itkImageFileReader.h>
#include <itkImageRegionIteratorWithIndex.h>
#include <itkLabelImageToShapeLabelMapFilter.h>
#include <itkMetaImageIO.h>
#include <itkMorphologicalWatershedImageFilter.h>
#include <itkOtsuThresholdImageFilter.h>
#include <itkSignedMaurerDistanceMapImageFilter.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace {

using Grey = itk::Image<unsigned short, 3>;
using Mask = itk::Image<unsigned char, 3>;
using Distance = itk::Image<float, 3>;
using Labels = itk::Image<unsigned int, 3>;

struct Container {
  double x, y, radius, bottom, top;
  bool holds(const Mask::PointType& p) const {
    return std::hypot(p[0] - x, p[1] - y) < radius && p[2] > bottom && p[2] < top;
  }
};

Mask::Pointer beads_of(const char* path, const Container& container) {
  auto reader = itk::ImageFileReader<Grey>::New();
  reader->SetImageIO(itk::MetaImageIO::New());
  reader->SetFileName(path);
  auto otsu = itk::OtsuThresholdImageFilter<Grey, Mask>::New();
  otsu->SetInput(reader->GetOutput());
  otsu->SetInsideValue(0);
  otsu->SetOutsideValue(1);
  otsu->Update();
  const Mask::Pointer mask = otsu->GetOutput();
  itk::ImageRegionIteratorWithIndex<Mask> voxel(mask, mask->GetLargestPossibleRegion());
  for (; !voxel.IsAtEnd(); ++voxel) {
    Mask::PointType p;
    mask->TransformIndexToPhysicalPoint(voxel.GetIndex(), p);
    if (!container.holds(p)) voxel.Set(0);
  }
  mask->DisconnectPipeline();
  return mask;
}

Labels::Pointer watershed_of(const Mask::Pointer& mask) {
  auto distance = itk::SignedMaurerDistanceMapImageFilter<Mask, Distance>::New();
  distance->SetInput(mask);
  distance->SetInsideIsPositive(false);  // basins where beads are
  distance->SetSquaredDistance(false);
  distance->SetUseImageSpacing(false);
  auto watershed = itk::MorphologicalWatershedImageFilter<Distance, Labels>::New();
  watershed->SetInput(distance->GetOutput());
  watershed->SetLevel(2.0);
  watershed->SetMarkWatershedLine(false);
  watershed->Update();
  const Labels::Pointer labels = watershed->GetOutput();
  itk::ImageRegionIterator<Labels> label(labels, labels->GetLargestPossibleRegion());
  itk::ImageRegionConstIterator<Mask> inside(mask, mask->GetLargestPossibleRegion());
  for (; !label.IsAtEnd(); ++label, ++inside)
    if (!inside.Get()) label.Set(0);
  labels->DisconnectPipeline();
  return labels;
}

}  // namespace

int main(int count, char** words) {
  if (count != 8) {
    std::fprintf(stderr, "watershed_bench VOLUME OUT.csv X_UM Y_UM RADIUS_UM BOTTOM_UM TOP_UM\n");
    return 2;
  }
  const auto number = [&](int n) { return std::strtod(words[n], nullptr); };
  const auto labels =
      watershed_of(beads_of(words[1], {number(3), number(4), number(5), number(6), number(7)}));
  auto shapes = itk::LabelImageToShapeLabelMapFilter<Labels>::New();
  shapes->SetInput(labels);
  shapes->Update();
  std::FILE* out = std::fopen(words[2], "w");
  if (!out) return 1;
  std::fprintf(out, "x_um,y_um,z_um,diameter_um\n");
  for (std::size_t n = 0; n < shapes->GetOutput()->GetNumberOfLabelObjects(); ++n) {
    const auto* body = shapes->GetOutput()->GetNthLabelObject(n);
    const auto centre = body->GetCentroid();
    std::fprintf(out, "%.4f,%.4f,%.4f,%.4f\n", centre[0], centre[1], centre[2],
                 2.0 * body->GetEquivalentSphericalRadius());
  }
  std::fclose(out);
}
