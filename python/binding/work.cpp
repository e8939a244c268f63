#include "binding/work.h"

#include "base/interrupt.h"
#include "binding/effect_failed.h"

namespace pendular::python {

Told::Told(py::object progress) : progress_(std::move(progress)) {
  if (!progress_.is_none() && !PyCallable_Check(progress_.ptr()))
    throw BadUsage("progress: expected a function of (what, done, note)");
}

Listener Told::listener() {
  Listener listener;
  listener.warned = [this](const std::string& line) { warnings_.push_back(line); };
  if (progress_.is_none()) return listener;
  listener.progress = [this](const std::string& what, double share, const std::string& note) {
    const py::gil_scoped_acquire held;
    if (failed_) return;
    try {
      progress_(what, share, note);
    } catch (py::error_already_set& error) {
      failed_.emplace(std::move(error));
      ask_to_stop();
    }
  };
  return listener;
}

void Told::warn() const {
  constexpr int kCaller = 2;  // of the Python function that called
  const py::object category = py::module_::import("pendular.errors").attr("PendularWarning");
  for (const auto& line : warnings_)
    if (PyErr_WarnEx(category.ptr(), line.c_str(), kCaller) != 0) throw py::error_already_set();
}

void Told::stop(const Interrupted& stopped) {
  if (failed_ && !failed_->matches(PyExc_KeyboardInterrupt)) throw std::move(*failed_);
  if (PyErr_CheckSignals() != 0 && !PyErr_ExceptionMatches(PyExc_KeyboardInterrupt))
    throw py::error_already_set();
  PyErr_Clear();
  PyErr_SetString(PyExc_KeyboardInterrupt, stopped.what());
  throw py::error_already_set();
}

namespace {

const char* class_of(const Error& error) {
  switch (error.exit_status()) {
    case 2:
      return "UsageError";
    case 3:
      return "InputError";
    default:
      return "ComputationError";
  }
}

}  // namespace

void translate_errors() {
  py::register_local_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      const py::module_ errors = py::module_::import("pendular.errors");
      py::object raised = errors.attr(class_of(error))(error.what());
      if (const auto* failed = dynamic_cast<const EffectFailed*>(&error))
        raised.attr("__cause__") = failed->cause();
      PyErr_SetObject(py::type::of(raised).ptr(), raised.ptr());
    }
  });
}

}  // namespace pendular::python
