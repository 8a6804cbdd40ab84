#pragma once
/// Sentences of the tool in Python's words: "noise= needs method='pca'", where the tool says "--noise needs --method
/// pca".

#include <string>
#include <string_view>

namespace python {

/// A sentence in which the tool's options are Python's arguments; options that the module has not stay as they are.
[[nodiscard]] std::string in_python(std::string_view sentence);

}  // namespace python
