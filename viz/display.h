#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/process.h"

// Xlib's own header defines names like Status and None. NOLINTNEXTLINE(bugprone-reserved-identifier)
struct _XDisplay;

namespace pendular::viz {

/// An X display to render on, there as long as this object lives: the one that DISPLAY names where it answers
/// and offers OpenGL (GLX), else a private Xvfb on a free display number that ends with this object, and also
/// when the program dies. Outlives every picture drawn on it. DISPLAY stays as it is.
/// Throws ComputationFailed where neither is to be had.
class Display {
 public:
  Display();
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  bool is_private() const { return server_.has_value(); }
  const std::string& name() const { return name_; }  ///< as in DISPLAY

  struct Close {
    void operator()(_XDisplay* connection) const;
  };
  using Connection = std::unique_ptr<_XDisplay, Close>;
  /// A connection to it. ComputationFailed where it does not answer any more.
  Connection connect() const;

 private:
  std::optional<Process> server_;  ///< the private Xvfb
  std::string name_;
};

}  // namespace pendular::viz
