#include "json.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <ostream>
#include <stdexcept>

namespace cli {

namespace {

template <class Wanted, class Value>
auto& held(Value& value, const char* what) {
  if (auto* found = std::get_if<Wanted>(&value)) return *found;
  throw std::logic_error(std::string("JSON that is no ") + what + " is taken for one");
}

}  // namespace

// ---- values --------------------------------------------------------------------------------------------------------

json::json(std::vector<json> values) : value_(std::move(values)) {}
json::json(const std::vector<double>& values) : value_(std::vector<json>(values.begin(), values.end())) {}
json::json(const std::vector<std::string>& values) : value_(std::vector<json>(values.begin(), values.end())) {}

json::json(std::initializer_list<json> values) {
  const auto is_member = [](const json& value) {
    const auto* pair = std::get_if<std::vector<json>>(&value.value_);
    return pair != nullptr && pair->size() == 2 && pair->front().is_string();
  };
  if (!std::ranges::all_of(values, is_member)) {
    value_ = std::vector<json>(values);
    return;
  }
  *this = object();
  for (const json& value : values) {
    const auto& pair = value.elements();
    if (!contains(pair[0].text())) items().emplace_back(pair[0].text(), pair[1]);
  }
}

json::json(const json& other) = default;
json::json(json&& other) noexcept = default;
json& json::operator=(const json& other) = default;
json& json::operator=(json&& other) noexcept = default;
json::~json() = default;

json json::array(std::initializer_list<json> values) {
  json result;
  result.value_ = std::vector<json>(values);
  return result;
}

json json::object() {
  json result;
  result.value_ = std::vector<member>();
  return result;
}

bool json::is_null() const noexcept { return std::holds_alternative<std::nullptr_t>(value_); }
bool json::is_string() const noexcept { return std::holds_alternative<std::string>(value_); }
bool json::is_number() const noexcept { return is_number_integer() || std::holds_alternative<double>(value_); }
bool json::is_array() const noexcept { return std::holds_alternative<std::vector<json>>(value_); }
bool json::is_object() const noexcept { return std::holds_alternative<std::vector<member>>(value_); }
bool json::is_number_integer() const noexcept {
  return std::holds_alternative<std::int64_t>(value_) || std::holds_alternative<std::uint64_t>(value_);
}

bool json::truth() const { return held<bool>(value_, "true or false"); }
const std::string& json::text() const { return held<std::string>(value_, "text"); }
const std::vector<json>& json::elements() const { return held<std::vector<json>>(value_, "array"); }
std::vector<json>& json::elements() { return held<std::vector<json>>(value_, "array"); }
const std::vector<json::member>& json::items() const { return held<std::vector<member>>(value_, "object"); }
std::vector<json::member>& json::items() { return held<std::vector<member>>(value_, "object"); }

double json::number() const {
  if (const auto* whole = std::get_if<std::int64_t>(&value_)) return static_cast<double>(*whole);
  if (const auto* whole = std::get_if<std::uint64_t>(&value_)) return static_cast<double>(*whole);
  return held<double>(value_, "number");
}

void json::push_back(json value) {
  if (is_null()) value_ = std::vector<json>();
  elements().push_back(std::move(value));
}

const json& json::operator[](std::size_t index) const { return elements().at(index); }
json& json::operator[](std::size_t index) { return elements().at(index); }

const json* json::find(const std::string& key) const {
  const auto found = std::ranges::find(items(), key, &member::first);
  return found == items().end() ? nullptr : &found->second;
}

json& json::operator[](const std::string& key) {
  if (is_null()) value_ = std::vector<member>();
  const auto found = std::ranges::find(items(), key, &member::first);
  return found != items().end() ? found->second : items().emplace_back(key, json()).second;
}

const json& json::operator[](const std::string& key) const {
  if (const json* found = find(key)) return *found;
  throw std::logic_error("JSON has no member '" + key + "'");
}

bool json::contains(const std::string& key) const { return is_object() && find(key) != nullptr; }

void json::update(const json& other) {
  for (const auto& [key, value] : other.items()) (*this)[key] = value;
}

std::size_t json::size() const noexcept {
  if (const auto* values = std::get_if<std::vector<json>>(&value_)) return values->size();
  if (const auto* members = std::get_if<std::vector<member>>(&value_)) return members->size();
  return 0;
}

bool operator==(const json& one, const json& other) {
  if (one.is_number() && other.is_number() && one.value_.index() != other.value_.index())
    return one.number() == other.number();
  return one.value_ == other.value_;
}

// ---- text ----------------------------------------------------------------------------------------------------------

/// To and from the library that reads and writes.
struct json_text {
  static nlohmann::ordered_json library_form(const json& from) {
    return std::visit(
        [](const auto& value) -> nlohmann::ordered_json {
          using held_type = std::decay_t<decltype(value)>;
          if constexpr (std::is_same_v<held_type, std::vector<json>>) {
            auto values = nlohmann::ordered_json::array();
            for (const json& each : value) values.push_back(library_form(each));
            return values;
          } else if constexpr (std::is_same_v<held_type, std::vector<json::member>>) {
            auto members = nlohmann::ordered_json::object();
            for (const auto& [key, each] : value) members[key] = library_form(each);
            return members;
          } else {
            return value;
          }
        },
        from.value_);
  }

  static json our_form(const nlohmann::ordered_json& from) {
    if (from.is_boolean()) return from.get<bool>();
    if (from.is_number_unsigned()) return from.get<std::uint64_t>();
    if (from.is_number_integer()) return from.get<std::int64_t>();
    if (from.is_number()) return from.get<double>();
    if (from.is_string()) return from.get<std::string>();
    json result;
    if (from.is_array()) result = json::array();
    if (from.is_object()) result = json::object();
    for (const auto& [key, value] : from.items())
      if (from.is_object())
        result[key] = our_form(value);
      else
        result.push_back(our_form(value));
    return result;
  }
};

json json::parse(const std::string& text) {
  const auto read = nlohmann::ordered_json::parse(text, nullptr, false);
  return read.is_discarded() ? json() : json_text::our_form(read);
}

std::string json::dump(int indent) const {
  return json_text::library_form(*this).dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::ostream& operator<<(std::ostream& stream, const json& value) { return stream << value.dump(); }

}  // namespace cli
