#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <vector>

#include <fill/program.hpp>

#include <hexhex/error.hpp>

#if defined(__unix__) || defined(__APPLE__)
#define HEXHEX_RUNS_PROGRAMS 1
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#if defined(__linux__)
#include <sys/prctl.h>
#endif
#endif

namespace hexhex::fill {

#if defined(HEXHEX_RUNS_PROGRAMS) && !defined(__EMSCRIPTEN__)
namespace {

[[noreturn]] void failToRun(const std::string& what) {
  throw Error(ErrorCode::FileUnsupported,
              "A mesher cannot be started: " + what + ": " + std::strerror(errno) + ".");
}

/// A file descriptor, closed at the end of its scope and on exec.
class Descriptor {
 public:
  Descriptor(int value, const char* what) : value_(value) {
    if (value < 0) failToRun(what);
    fcntl(value, F_SETFD, FD_CLOEXEC);
  }
  ~Descriptor() { close(value_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int value() const noexcept { return value_; }

 private:
  int value_;
};

/// Runs in the new process: must neither allocate memory nor take locks.
[[noreturn]] void become(char* const* words, const char* folder, int input, int output,
                         [[maybe_unused]] pid_t parent) {
#if defined(__linux__)
  // Ensures that the child does not outlive its parent, however that ends.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
#endif
  if (dup2(input, 0) >= 0 && dup2(output, 1) >= 0 && dup2(output, 2) >= 0 && chdir(folder) == 0) {
    execvp(words[0], words);
  }
  _exit(ProgramEnd::kNotFound);
}

/// A running program, which is killed when this object is destroyed.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {
    if (id < 0) failToRun("no other process");
  }
  ~Child() {
    if (ended_) return;
    kill(id_, SIGKILL);
    while (waitpid(id_, &status_, 0) < 0 && errno == EINTR) {
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  [[nodiscard]] bool hasEnded() {
    const pid_t result = waitpid(id_, &status_, WNOHANG);
    if (result < 0 && errno != EINTR) failToRun("its end is unknown");
    ended_ = result == id_;
    return ended_;
  }
  [[nodiscard]] int code() const noexcept {
    constexpr int kSignal = 128;
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : kSignal + WTERMSIG(status_);
  }

 private:
  pid_t id_;
  int status_ = 0;
  bool ended_ = false;
};

}  // namespace

ProgramEnd runProgram(const std::vector<std::string>& words, const std::filesystem::path& folder,
                      Context& context) {
  constexpr std::chrono::milliseconds kPause(20);
  const std::string said = folder / "said.txt";
  std::vector<std::string> copies = words;
  std::vector<char*> pointers;
  pointers.reserve(copies.size() + 1);
  for (std::string& word : copies) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) failToRun("no pipe");
  // The program's input ends when this process does; nothing is ever written to it.
  const Descriptor input(ends[0], "no pipe");
  const Descriptor open(ends[1], "no pipe");
  const Descriptor output(::open(said.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND, 0600),
                          "no file");
  const pid_t parent = getpid();
  const pid_t id = fork();
  if (id == 0) become(pointers.data(), folder.c_str(), input.value(), output.value(), parent);
  Child child(id);
  while (!child.hasEnded()) {
    context.throwIfCancelled();
    std::this_thread::sleep_for(kPause);
  }
  std::ifstream file(said, std::ios::binary);
  return {child.code(), {std::istreambuf_iterator<char>(file), {}}};
}

TemporaryFolder::TemporaryFolder() {
  std::error_code problem;
  const std::filesystem::path place = std::filesystem::temp_directory_path(problem);
  if (problem) {
    throw Error(ErrorCode::FileWrite, "There is no folder for temporary files: " +
                                          problem.message() + ". The variable TMPDIR names one.");
  }
  std::string name = place / "hexhex-XXXXXX";
  if (mkdtemp(name.data()) == nullptr) {
    throw Error(ErrorCode::FileWrite, name + ": no folder can be made: " + std::strerror(errno) +
                                          ". The variable TMPDIR names another place.");
  }
  path_ = name;
}
#else
ProgramEnd runProgram(const std::vector<std::string>& /*words*/,
                      const std::filesystem::path& /*folder*/, Context& /*context*/) {
  throw Error(ErrorCode::FileUnsupported,
              "On this system, hexhex starts no other programs. Fill the surface with tets by "
              "hand.");
}

TemporaryFolder::TemporaryFolder() {
  throw Error(
      ErrorCode::FileUnsupported,
      "On this system, hexhex starts no meshers. Fill the part with tets by hand (fTetWild, "
      "Netgen, Gmsh, TetGen).");
}
#endif

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace hexhex::fill
