#pragma once

#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

#include <sstream>
#include <string>
#include <vector>

namespace tissue_stiffness {

/// An element of an XML file, by a parser that takes well-formed files alone.
class XmlElement {
 public:
  explicit XmlElement(const std::string& text)
      : owned_(vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromString(text.c_str()))),
        element_(owned_) {}
  explicit XmlElement(vtkXMLDataElement* element) : element_(element) {}

  bool exists() const { return element_ != nullptr; }
  std::string name() const { return element_->GetName(); }
  std::string attribute(const std::string& key) const {
    const char* value = exists() ? element_->GetAttribute(key.c_str()) : nullptr;
    return value == nullptr ? "" : value;
  }
  std::string text() const {
    const char* value = exists() ? element_->GetCharacterData() : nullptr;
    return value == nullptr ? "" : value;
  }
  std::vector<XmlElement> children(const std::string& name = "") const {
    std::vector<XmlElement> out;
    for (int i = 0; exists() && i < element_->GetNumberOfNestedElements(); ++i) {
      vtkXMLDataElement* child = element_->GetNestedElement(i);
      if (name.empty() || name == child->GetName()) out.emplace_back(child);
    }
    return out;
  }
  /// The first child of this name.
  XmlElement child(const std::string& name) const {
    const std::vector<XmlElement> all = children(name);
    return all.empty() ? XmlElement(nullptr) : all.front();
  }

 private:
  vtkSmartPointer<vtkXMLDataElement> owned_;
  vtkXMLDataElement* element_;
};

/// Numbers between blanks or commas.
inline std::vector<double> numbers_of(std::string text) {
  for (char& c : text) c = c == ',' ? ' ' : c;
  std::istringstream in(text);
  std::vector<double> out;
  for (double number = 0.0; in >> number;) out.push_back(number);
  return out;
}

}  // namespace tissue_stiffness
