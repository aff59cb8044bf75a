#include "command_line.h"

#include <iostream>

#include "s2s/core/error.h"

namespace s2s::apps {

namespace {

int report(const CLI::App& app, const std::exception& e, ExitCode code) {
  std::cerr << app.get_name() << ": " << e.what() << '\n';
  return code;
}

}  // namespace

int run(CLI::App& app, int argc, char** argv, const std::function<int()>& body) {
  app.get_formatter()->column_width(34);
  app.set_version_flag("--version", S2S_VERSION);
  try {
    app.parse(argc, argv);
    return body();
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);
    std::cerr << app.get_name() << ": " << e.what() << "\nRun '" << app.get_name() << " --help' for all options.\n";
    return kUsageError;
  } catch (const core::ConfigError& e) {
    return report(app, e, kUsageError);
  } catch (const core::InputError& e) {
    return report(app, e, kUnusableInput);
  } catch (const core::OutputError& e) {
    return report(app, e, kUnwritableOutput);
  } catch (const std::exception& e) {
    return report(app, e, kInternalError);
  }
}

}  // namespace s2s::apps
