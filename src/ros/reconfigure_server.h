#pragma once

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/ros.h>

#include <functional>
#include <string>
#include <utility>

namespace uav_landing {

/// Names, ranges and meanings of a parameter struct, as dynamic_reconfigure describes them to its clients.
/// visit(): as in uav_landing/parameters/parameters.h. The values are the struct's defaults.
class ReconfigureDescription {
 public:
  void number(const char* name, double value, double min, double max, const char* unit, const char* meaning);
  void number(const char* name, int value, int min, int max, const char* unit, const char* meaning);
  void flag(const char* name, bool value, const char* meaning);
  void text(const char* name, const std::string& value, const char* meaning);

  const dynamic_reconfigure::ConfigDescription& message() const { return description_; }

 private:
  void add(const char* name, const char* type, const std::string& meaning);

  dynamic_reconfigure::ConfigDescription description_;
};

/// Reads the values of a request. Parameters that it does not name stay as they are. node: name for the
/// warnings.
class ReconfigureRequestReader {
 public:
  ReconfigureRequestReader(const dynamic_reconfigure::Config& request, const std::string& node)
      : request_(request), node_(node) {}
  void number(const char* name, double& value, double min, double max, const char* unit, const char* meaning);
  void number(const char* name, int& value, int min, int max, const char* unit, const char* meaning);
  void flag(const char* name, bool& value, const char* meaning);
  void text(const char* name, std::string& value, const char* meaning);

 private:
  template <class Value>
  Value inRange(const char* name, Value given, Value min, Value max, const char* unit) const;

  const dynamic_reconfigure::Config& request_;
  const std::string& node_;
};

/// The server side of dynamic_reconfigure for a parameter struct. It uses the same visit() that reads and
/// documents the struct. A value out of range becomes the nearest one in range, as clients expect, with a
/// warning. Topics and service are private names of the handle. Callbacks run where those of the handle do.
template <class Parameters>
class ReconfigureServer {
 public:
  /// changed is called with every new set of parameters.
  ReconfigureServer(const ros::NodeHandle& private_handle, const Parameters& parameters,
                    std::function<void(const Parameters&)> changed)
      : handle_(private_handle),
        parameters_(parameters),
        changed_(std::move(changed)),
        descriptions_(
            handle_.advertise<dynamic_reconfigure::ConfigDescription>("parameter_descriptions", 1, true)),
        updates_(handle_.advertise<dynamic_reconfigure::Config>("parameter_updates", 1, true)) {
    ReconfigureDescription description;
    Parameters().visit(description);
    descriptions_.publish(description.message());
    updates_.publish(current());
    service_ = handle_.advertiseService("set_parameters", &ReconfigureServer::set, this);
  }

 private:
  dynamic_reconfigure::Config current() {
    ReconfigureDescription description;
    parameters_.visit(description);
    return description.message().dflt;
  }

  bool set(dynamic_reconfigure::ReconfigureRequest& request,
           dynamic_reconfigure::ReconfigureResponse& response) {
    parameters_.visit(ReconfigureRequestReader(request.config, handle_.getNamespace()));
    changed_(parameters_);
    response.config = current();
    updates_.publish(response.config);
    return true;
  }

  ros::NodeHandle handle_;
  Parameters parameters_;
  const std::function<void(const Parameters&)> changed_;
  ros::Publisher descriptions_, updates_;
  ros::ServiceServer service_;
};

}  // namespace uav_landing
