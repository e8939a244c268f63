#include "viz/display.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>

#include "base/error.h"
#include "scratch.h"

// After GoogleTest, whose None it would redefine.
#include <X11/Xlib.h>

namespace pendular {
namespace {

/// Sets or (with nullptr) unsets an environment variable as long as it lives.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) {
    if (const char* former = std::getenv(name)) former_ = former;
    apply(value);
  }
  ~Environment() { apply(former_ ? former_->c_str() : nullptr); }

 private:
  void apply(const char* value) { value != nullptr ? ::setenv(name_, value, 1) : ::unsetenv(name_); }
  const char* name_;
  std::optional<std::string> former_;
};

bool answers(const std::string& display) {
  ::Display* connection = XOpenDisplay(display.c_str());
  if (connection != nullptr) XCloseDisplay(connection);
  return connection != nullptr;
}

bool goes_away(const std::string& display) {
  for (int k = 0; k < 200 && answers(display); ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  return !answers(display);
}

/// A process of its own that opens a display, tells its name and waits to be killed.
struct Other {
  pid_t process;
  std::string display;
};
Other start_other() {
  int ends[2];
  EXPECT_EQ(::pipe(ends), 0);
  const pid_t process = ::fork();
  if (process == 0) {
    const viz::Display display;
    const std::string name = display.name();
    if (::write(ends[1], name.data(), name.size()) < 0) ::_exit(1);
    ::pause();
    ::_exit(0);
  }
  char name[32] = {};
  const ssize_t length = ::read(ends[0], name, sizeof name - 1);
  ::close(ends[0]);
  ::close(ends[1]);
  return {process, std::string(name, length > 0 ? static_cast<std::size_t>(length) : 0)};
}

TEST(Display, StartsAPrivateServerWhereDisplayIsUnset) {
  const Environment unset("DISPLAY", nullptr);
  std::string name;
  {
    const viz::Display display;
    EXPECT_TRUE(display.is_private());
    name = display.name();
    EXPECT_TRUE(answers(name));
    EXPECT_EQ(std::getenv("DISPLAY"), nullptr) << "the environment is the caller's";
  }
  EXPECT_TRUE(goes_away(name));
}

TEST(Display, UsesTheOneThatAnswers) {
  const Environment unset("DISPLAY", nullptr);
  const viz::Display outer;
  EXPECT_TRUE(outer.is_private());
  const Environment named("DISPLAY", outer.name().c_str());
  const viz::Display inner;
  EXPECT_FALSE(inner.is_private());
  EXPECT_EQ(inner.name(), outer.name());
}

TEST(Display, FallsBackWhereDisplayDoesNotAnswer) {
  const Environment bad("DISPLAY", ":54321");
  const viz::Display display;
  EXPECT_TRUE(display.is_private());
  EXPECT_NE(display.name(), ":54321");
  EXPECT_STREQ(std::getenv("DISPLAY"), ":54321");
}

TEST(Display, NamesThePackageWhereXvfbIsMissing) {
  const test::ScratchFolder empty;
  const Environment unset("DISPLAY", nullptr), nowhere("PATH", empty.path().c_str());
  try {
    const viz::Display display;
    FAIL() << "a display without a server";
  } catch (const ComputationFailed& error) {
    EXPECT_NE(std::string(error.what()).find("package xvfb"), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

TEST(Display, ProgramsDoNotCollideAndTheServerDiesWithItsProgram) {
  const Environment unset("DISPLAY", nullptr);
  const Other a = start_other(), b = start_other();
  ASSERT_FALSE(a.display.empty());
  ASSERT_FALSE(b.display.empty());
  EXPECT_NE(a.display, b.display);
  EXPECT_TRUE(answers(a.display));
  EXPECT_TRUE(answers(b.display));
  for (const Other& other : {a, b}) {
    ::kill(other.process, SIGKILL);
    ::waitpid(other.process, nullptr, 0);
    EXPECT_TRUE(goes_away(other.display)) << other.display;
  }
}

}  // namespace
}  // namespace pendular
