#pragma once
/// Results as JSON; objects keep the order of their keys. Only json.cpp includes nlohmann's library, which takes
/// seconds to compile. The text is the one that nlohmann's ordered_json prints.

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iosfwd>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace cli {

/// Null, true or false, a number, a text, an array or an object. Braces make an object if all elements are pairs that
/// begin with a text, otherwise an array.
class json {
 public:
  using member = std::pair<std::string, json>;

  json() noexcept = default;
  json(std::nullptr_t) noexcept {}
  json(bool value) : value_(value) {}
  json(int value) : value_(std::int64_t{value}) {}
  json(long value) : value_(std::int64_t{value}) {}
  json(long long value) : value_(std::int64_t{value}) {}
  json(unsigned value) : value_(std::uint64_t{value}) {}
  json(unsigned long value) : value_(std::uint64_t{value}) {}
  json(unsigned long long value) : value_(std::uint64_t{value}) {}
  json(double value) : value_(value) {}
  json(const char* value) : value_(std::string(value)) {}
  json(std::string_view value) : value_(std::string(value)) {}
  json(std::string value) : value_(std::move(value)) {}
  json(std::vector<json> values);
  json(const std::vector<double>& values);
  json(const std::vector<std::string>& values);
  json(std::initializer_list<json> values);
  template <class T>
  json(T*) = delete;  // a pointer would become true or false

  json(const json& other);
  json(json&& other) noexcept;
  json& operator=(const json& other);
  json& operator=(json&& other) noexcept;
  ~json();

  [[nodiscard]] static json array(std::initializer_list<json> values = {});
  [[nodiscard]] static json object();
  /// The deepest nesting and the most values that `read` accepts. Nesting is limited: destroying and printing recurse.
  static constexpr std::size_t deepest = 100, most_values = 1 << 18;
  /// Returns null if the text is not JSON or exceeds these limits.
  [[nodiscard]] static json read(const std::string& text);

  [[nodiscard]] bool is_null() const noexcept;
  [[nodiscard]] bool is_string() const noexcept;
  [[nodiscard]] bool is_number() const noexcept;
  [[nodiscard]] bool is_number_integer() const noexcept;
  [[nodiscard]] bool is_array() const noexcept;
  [[nodiscard]] bool is_object() const noexcept;

  // These functions return the content. They throw std::logic_error if the value is of another type.
  [[nodiscard]] bool truth() const;
  [[nodiscard]] double number() const;
  [[nodiscard]] const std::string& text() const;
  [[nodiscard]] const std::vector<json>& elements() const;
  [[nodiscard]] std::vector<json>& elements();
  [[nodiscard]] const std::vector<member>& items() const;
  [[nodiscard]] std::vector<member>& items();

  /// These functions are for arrays; `push_back` first turns null into an array.
  void push_back(json value);
  [[nodiscard]] const json& operator[](std::size_t index) const;
  [[nodiscard]] json& operator[](std::size_t index);

  /// For objects; null becomes an object, and a missing key is added. The const version throws std::logic_error.
  [[nodiscard]] json& operator[](const std::string& key);
  [[nodiscard]] const json& operator[](const std::string& key) const;
  [[nodiscard]] bool contains(const std::string& key) const;
  /// Adds the members of another object. They replace members with the same keys.
  void update(const json& other);

  /// Returns the number of elements of an array or members of an object.
  [[nodiscard]] std::size_t size() const noexcept;
  [[nodiscard]] bool empty() const noexcept { return size() == 0; }

  /// Returns the text on one line, or indented. Bytes that are not UTF-8 are replaced.
  [[nodiscard]] std::string dump(int indent = -1) const;

  /// Numbers of different types are compared by value.
  friend bool operator==(const json& one, const json& other);

 private:
  friend struct json_text;

  [[nodiscard]] const json* find(const std::string& key) const;

  std::variant<std::nullptr_t, bool, std::int64_t, std::uint64_t, double, std::string, std::vector<json>,
               std::vector<member>>
      value_;
};

std::ostream& operator<<(std::ostream& stream, const json& value);

}  // namespace cli
