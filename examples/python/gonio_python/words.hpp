#pragma once
/// Sentences of the tool in Python's terms: "noise= needs method='pca'" for the tool's "--noise needs --method pca".

#include <string>
#include <string_view>

namespace python {

/// Replaces the tool's options in a sentence by Python's arguments; options that the module lacks stay as they are.
[[nodiscard]] std::string in_python(std::string_view sentence);

}  // namespace python
