#pragma once
/// JSON that is compiled once to be read: the tool's output, and golden files of the Python reference.

#include <nlohmann/json.hpp>

#include <string>

/// Of a text, or of what is behind a tool's warnings, each a line of it. Throws nlohmann::json::parse_error if there is
/// none.
[[nodiscard]] nlohmann::json read_json(const std::string& text);

/// A file of tests/data.
[[nodiscard]] nlohmann::json golden_json(const std::string& name);
