/// Priors: whole files, or the payload of one, to which the checksum is added.

#include "harness.hpp"
#include <gonio/io/checked_file.hpp>
#include <gonio/io/prior.hpp>

namespace {

void read(fuzz::input bytes) {
  const gonio::io::checked_file_kind kind{"gonio-pca", 1, "prior"};
  if (fuzz::text_of(bytes).starts_with(kind.magic))
    static_cast<void>(gonio::io::decode_prior(bytes, fuzz::bytes_name));
  else
    static_cast<void>(gonio::io::decode_prior(gonio::io::encode_checked(kind, bytes), fuzz::bytes_name));
}

const fuzz::registered harness("prior", &read);

}  // namespace
