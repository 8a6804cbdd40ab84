#pragma once
/// The negative answer of a subcommand that answers a question.

namespace cli {

/// Thrown by a subcommand after it has printed its answer: the program ends with exit code 1, like grep and diff, and
/// prints nothing more. Such a subcommand must throw every failure as gonio::error, whose exit code is 2, so that 1
/// only means no.
struct negative_answer {};

}  // namespace cli
