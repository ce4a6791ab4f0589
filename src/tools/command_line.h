#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <iostream>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "parameters/section_loader.h"
#include "uav_landing/image/rig_masks.h"
#include "uav_landing/parameters/parameter_file.h"
#include "uav_landing/parameters/parameters.h"

namespace uav_landing {

/// Exit status of all programs. kMostLeftOut: finished, but most images could not be used.
enum ExitStatus { kDone = 0, kInputUnusable = 1, kWrongUsage = 2, kMostLeftOut = 3 };

/// Describes what is wrong with the command line, to follow the program's name. A misspelt option comes with
/// the nearest existing one, also when the misspelling leaves a required option missing.
inline std::string usageMessage(const CLI::App* app, const CLI::Error& error) {
  std::string problem = error.what();
  const bool unexpected = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError);
  if (unexpected || error.get_exit_code() == static_cast<int>(CLI::ExitCodes::RequiredError)) {
    const std::vector<std::string> extras = app->remaining();
    const auto option = std::find_if(extras.begin(), extras.end(),
                                     [](const std::string& word) { return word.rfind("--", 0) == 0; });
    if (option != extras.end()) {
      std::vector<std::string> names;
      for (const CLI::Option* known : app->get_options())
        for (const std::string& name : known->get_lnames()) names.push_back("--" + name);
      const std::string given = option->substr(0, option->find('='));
      problem = given + ": no such option" + suggestName(given, names);
    } else if (!extras.empty() && unexpected) {
      problem = extras.front() + ": not expected";
    }
  }
  return app->get_name() + ": " + problem + "\nRun with --help for more information.\n";
}

/// Parses the command line, --version included. Returns an exit status when nothing is left to do, because
/// help was asked for or the usage was wrong. Everything is written by then.
inline std::optional<int> parseCommandLine(CLI::App& app, int argc, char** argv) {
  app.add_flag_callback(
      "--version",
      [&app] {
        std::cout << app.get_name() << " " UAV_LANDING_VERSION "\n";
        throw CLI::Success();
      },
      "print the version and leave");
  app.failure_message(usageMessage);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kWrongUsage;
  }
  return std::nullopt;
}

/// Writes "program: message" to stderr and returns the status for unusable input.
inline int inputUnusable(const CLI::App& app, const std::string& message) {
  std::cerr << app.get_name() << ": " << message << '\n';
  return kInputUnusable;
}

/// Runs the program's work, which returns a Failure or throws. Returns the exit status. file: name for
/// exceptions that do not name their file; "" when the text is enough.
template <class Work>
int exitStatusOf(const CLI::App& app, const std::string& file, Work&& work) {
  try {
    if (const Failure failure = work()) return inputUnusable(app, failure.detail);
  } catch (const std::exception& error) {
    return inputUnusable(app, (file.empty() ? "" : file + ": ") + error.what());
  }
  return kDone;
}

/// The chain's parameters from --config, or the defaults without it. Masks that cannot be read are refused
/// before anything else is read.
inline Expected<Parameters> parametersOf(const std::string& config) {
  if (config.empty()) return Parameters();
  Expected<Parameters> parameters = loadParameterFile(config);
  if (!parameters) return parameters;
  const Expected<RigMasks> masks = loadRigMasks(parameters->rig);
  if (!masks) return tl::make_unexpected(masks.error());
  return parameters;
}

/// Check for a camera namespace such as "stereo" or "uav1/stereo".
inline CLI::Validator isCameraName() {
  return CLI::Validator(
      [](const std::string& name) -> std::string {
        static const std::regex pattern("[A-Za-z][A-Za-z0-9_]*(/[A-Za-z][A-Za-z0-9_]*)*");
        return std::regex_match(name, pattern) ? ""
                                               : "\"" + name + "\" is not a name like stereo or uav1/stereo";
      },
      "NAME");
}

}  // namespace uav_landing
