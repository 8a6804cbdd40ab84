#include "json.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <numeric>
#include <ostream>
#include <stdexcept>
#include <tuple>

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

namespace {

/// Builds a value from the events of nlohmann's parser, which does not recurse. Events that return false stop it.
class json_reader {
 public:
  using number_integer_t = nlohmann::json::number_integer_t;
  using number_unsigned_t = nlohmann::json::number_unsigned_t;
  using number_float_t = nlohmann::json::number_float_t;
  using string_t = nlohmann::json::string_t;
  using binary_t = nlohmann::json::binary_t;

  bool null() { return add(json()); }
  bool boolean(bool value) { return add(value); }
  bool number_integer(number_integer_t value) { return add(std::int64_t{value}); }
  bool number_unsigned(number_unsigned_t value) { return add(std::uint64_t{value}); }
  bool number_float(number_float_t value, const string_t&) { return add(value); }
  bool string(string_t& value) { return add(std::move(value)); }
  bool binary(binary_t&) { return false; }
  bool start_object(std::size_t) { return open(json::object()); }
  bool start_array(std::size_t) { return open(json::array()); }
  bool key(string_t& name) {
    open_.back().key = std::move(name);
    return true;
  }
  bool end_object() {
    keep_last_of_each_key(open_.back().value.items());
    return close();
  }
  bool end_array() { return close(); }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception&) { return false; }

  [[nodiscard]] json read() && { return std::move(whole_); }

 private:
  struct opened {
    json value;
    std::string key;  ///< of the next member
  };

  bool add(json value) {
    if (++values_ > json::most_values) return false;
    if (open_.empty())
      whole_ = std::move(value);
    else if (open_.back().value.is_object())
      open_.back().value.items().emplace_back(std::move(open_.back().key), std::move(value));
    else
      open_.back().value.push_back(std::move(value));
    return true;
  }

  bool open(json value) {
    if (open_.size() == json::deepest) return false;
    open_.push_back({std::move(value), {}});
    return true;
  }

  bool close() {
    json value = std::move(open_.back().value);
    open_.pop_back();
    return add(std::move(value));
  }

  /// A repeated key keeps its first position and its last value, as in nlohmann's ordered objects.
  static void keep_last_of_each_key(std::vector<json::member>& members) {
    std::vector<std::size_t> by_key(members.size());
    std::iota(by_key.begin(), by_key.end(), std::size_t{0});
    std::ranges::sort(by_key, [&](std::size_t i, std::size_t j) {
      return std::tie(members[i].first, i) < std::tie(members[j].first, j);
    });
    std::vector<bool> repeated(members.size());
    for (std::size_t i = 1, first = 0; i < by_key.size(); ++i) {
      if (members[by_key[i]].first != members[by_key[first]].first) {
        first = i;
        continue;
      }
      members[by_key[first]].second = std::move(members[by_key[i]].second);
      repeated[by_key[i]] = true;
    }
    std::size_t i = 0;
    std::erase_if(members, [&](const json::member&) { return repeated[i++]; });
  }

  json whole_;
  std::vector<opened> open_;
  std::size_t values_ = 0;
};

}  // namespace

/// Converts a value to nlohmann's type, whose writer prints it.
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
            // nlohmann's own insertion would search all members.
            auto& list = members.get_ref<nlohmann::ordered_json::object_t&>();
            for (const auto& [key, each] : value) list.emplace_back(key, library_form(each));
            return members;
          } else {
            return value;
          }
        },
        from.value_);
  }
};

json json::read(const std::string& text) {
  json_reader reader;
  return nlohmann::json::sax_parse(text, &reader) ? std::move(reader).read() : json();
}

std::string json::dump(int indent) const {
  return json_text::library_form(*this).dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::ostream& operator<<(std::ostream& stream, const json& value) { return stream << value.dump(); }

}  // namespace cli
