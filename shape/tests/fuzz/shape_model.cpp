/// Reads shape models: whole files, or the payload of one, to which the checksum is added.

#include "fuzz/harness.hpp"
#include <gonio/io/bytes/checked_file.hpp>
#include <gonio/shape/io/shape_model.hpp>

namespace {

void read(fuzz::input bytes) {
  const gonio::io::checked_file_kind& kind = gonio::io::detail::shape_model_kind;
  if (fuzz::text_of(bytes).starts_with(kind.magic))
    static_cast<void>(gonio::io::read_shape_model(bytes, fuzz::bytes_name));
  else
    static_cast<void>(gonio::io::read_shape_model(gonio::io::write_checked(kind, bytes), fuzz::bytes_name));
}

const fuzz::registered harness("shape_model", &read);

}  // namespace
