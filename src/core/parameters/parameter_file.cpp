#include "uav_landing/parameters/parameter_file.h"

#include <filesystem>
#include <sstream>

#include "parameters/moved_parameters.h"
#include "parameters/parameter_sections.h"
#include "parameters/table_writer.h"

namespace uav_landing {
Expected<Parameters> parseParameters(const std::string& yaml_text, const std::string& name) {
  return parseSections<Parameters>(yaml_text, name);
}

Expected<Parameters> loadParameterFile(const std::string& path) {
  Expected<Parameters> parameters = loadSectionFile<Parameters>(path);
  if (parameters) resolveFiles(path, parameters->rig);
  return parameters;
}

void resolveFiles(const std::string& config_file, RigParameters& parameters) {
  const std::filesystem::path folder = std::filesystem::absolute(config_file).parent_path();
  for (std::string* file : {&parameters.left_mask, &parameters.right_mask})
    if (!file->empty()) *file = (folder / *file).lexically_normal().string();
}

std::string parameterTable() {
  std::ostringstream out;
  out << "# Parameters\n\nAll parameters of the chain, section by section as in `config/stereo.yaml`. "
         "All stages share `rig` and `runway`; the\nother sections belong to the nodelet of their name. "
         "What the tests of the height compare, and which limits they have:\n"
         "[tests of integrity](integrity_tests.md).\n";
  Parameters parameters;
  parameters.visitSections(
      [&](const char* section, auto& values) { values.visit(TableWriter(out, section)); });
  out << "\n## Moved\n\nEarlier versions had these elsewhere. They are refused with their new place.\n\n"
         "| was | is now |\n|---|---|\n";
  for (const MovedParameter& moved : kMovedParameters)
    out << "| `" << moved.was << "` | `" << moved.now << "` |\n";
  return out.str();
}

}  // namespace uav_landing
