#include "support/run_main.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>

#include "agricolmap/core/error.hpp"
#include "support/exit_code.hpp"

namespace agricolmap {

int runMain(CLI::App& app, int argc, char** argv, const std::function<void()>& action) {
  const auto fail = [&](const char* what, ExitCode code) {
    fmt::print(stderr, "{}: {}\n", app.get_name(), what);
    return static_cast<int>(code);
  };
  try {
    app.parse(argc, argv);
    action();
    return static_cast<int>(ExitCode::kOk);
  } catch (const CLI::ParseError& error) {
    return static_cast<int>(app.exit(error) == 0 ? ExitCode::kOk : ExitCode::kUsage);
  } catch (const Error& error) {
    return fail(error.what(), exitCodeOf(error.kind()));
  } catch (const std::bad_alloc&) {
    return fail("out of memory", ExitCode::kInternal);
  } catch (const std::exception& error) {
    return fail(error.what(), ExitCode::kInternal);
  }
}

}  // namespace agricolmap
