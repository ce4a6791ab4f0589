#pragma once

#include <ros/serialization.h>

#include <boost/array.hpp>
#include <functional>
#include <string>
#include <vector>

namespace uav_landing {

/// Visits all fields of a message of this package in the order of its definition, through the code that
/// serialises it, so that no field can be forgotten. Headers are left alone.
class FieldVisitor {
 public:
  std::function<void(double&)> on_number = [](double&) {};
  std::function<void(uint32_t&)> on_count = [](uint32_t&) {};
  std::function<void(std::string&)> on_text = [](std::string&) {};
  /// Of each sequence; resizes it.
  std::function<size_t(size_t)> on_length = [](size_t length) { return length; };

  template <class Message>
  void visit(Message& message) {
    ros::serialization::Serializer<Message>::template allInOne<FieldVisitor, Message&>(*this, message);
  }

  // Called by the serialisers.
  void next(std_msgs::Header&) {}
  void next(double& number) { on_number(number); }
  void next(uint32_t& count) { on_count(count); }
  void next(uint8_t&) {}
  void next(std::string& text) { on_text(text); }
  template <class Element, size_t kSize>
  void next(boost::array<Element, kSize>& elements) {
    for (Element& element : elements) next(element);
  }
  template <class Element>
  void next(std::vector<Element>& elements) {
    elements.resize(on_length(elements.size()));
    for (Element& element : elements) next(element);
  }
  template <class Message>
  void next(Message& message) {
    visit(message);
  }
};

}  // namespace uav_landing
