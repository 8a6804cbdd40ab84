#pragma once
/// How a subcommand that answers a question says no.

namespace cli {

/// Thrown by the work of a subcommand after it has printed its answer: the program ends with exit code 1, as those of
/// grep and diff do, and prints nothing more. Such a subcommand has to throw whatever else fails as gonio::error, whose
/// exit code is 2, so that 1 means no and nothing else.
struct negative_answer {};

}  // namespace cli
