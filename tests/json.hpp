#pragma once
/// JSON that is compiled once to be read: the tool's output, and golden files of the Python reference.

#include <nlohmann/json.hpp>

#include <string>

/// Throws nlohmann::json::parse_error if it is none.
[[nodiscard]] nlohmann::json read_json(const std::string& text);

/// A file of tests/data.
[[nodiscard]] nlohmann::json golden_json(const std::string& name);
