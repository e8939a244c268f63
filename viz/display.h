#pragma once

#include <optional>
#include <string>

#include "base/process.h"

namespace pendular::viz {

/// An X display to render on, there as long as this object lives: the one that DISPLAY names where it answers
/// and offers OpenGL (GLX), else a private Xvfb on a free display number that ends with this object, and also
/// when the program dies. Outlives every picture drawn on it. One at a time in a program: it sets DISPLAY.
/// Throws ComputationFailed where neither is to be had.
class Display {
 public:
  Display();
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  bool is_private() const { return server_.has_value(); }

 private:
  std::optional<Process> server_;  ///< the private Xvfb
  std::string former_;
  bool had_former_ = false;
};

}  // namespace pendular::viz
