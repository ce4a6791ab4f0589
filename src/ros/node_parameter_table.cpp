#include "node_parameter_table.h"

#include <sstream>

#include "autopilot_messages.h"
#include "node_parameters.h"
#include "parameters/table_writer.h"

namespace uav_landing {

std::string nodeParameterTable() {
  std::ostringstream out;
  out << "# Parameters of the nodelets alone\n\n"
         "Private parameters (`/uav_landing/<nodelet>/<name>`) that concern ROS and are not in a config "
         "file: for a launch "
         "file of\nyour own. `stereo.launch` and `autopilot.launch` set most of them by their arguments.\n";
  NodeParameters().visit(TableWriter(out, "Every nodelet"));
  AutopilotParameters().visit(TableWriter(out, "autopilot"));
  return out.str();
}

}  // namespace uav_landing
