/// Priors, and files of a soft and a specular one: whole files, or the payload of a prior, to which the checksum is
/// added.

#include "harness.hpp"
#include <gonio/io/bytes/checked_file.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/materials/soft_specular_prior.hpp>

namespace {

void read(fuzz::input bytes) {
  const gonio::io::checked_file_kind kind{"gonio-pca", 1, "prior"};
  const gonio::io::checked_file_kind split{"gonio-split", 1, "soft and specular prior"};
  if (fuzz::text_of(bytes).starts_with(split.magic))
    // What follows the magic word is a payload: with a checksum of its own hardly anything would get through.
    static_cast<void>(gonio::io::read_soft_specular_prior(
        gonio::io::write_checked(split, bytes.subspan(split.magic.size())), fuzz::bytes_name));
  else if (fuzz::text_of(bytes).starts_with(kind.magic))
    static_cast<void>(gonio::io::read_prior(bytes, fuzz::bytes_name));
  else
    static_cast<void>(gonio::io::read_prior(gonio::io::write_checked(kind, bytes), fuzz::bytes_name));
}

const fuzz::registered harness("prior", &read);

}  // namespace
