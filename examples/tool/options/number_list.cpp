#include "number_list.hpp"

#include <gonio/core/error.hpp>
#include <gonio/io/text/text.hpp>

namespace cli {

std::vector<double> numbers_in(std::string_view list, std::string_view option) {
  std::vector<std::string_view> fields;
  gonio::io::split_fields(list, fields);
  std::vector<double> numbers(fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (const char* wrong = gonio::io::read_number(fields[i], numbers[i]))
      gonio::refuse({option, ": number ", i + 1, " of a list, ", gonio::io::in_quotes(fields[i]), ",", wrong});
  return numbers;
}

}  // namespace cli
