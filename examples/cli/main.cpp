/// The `gonio` command-line tool: reports bad input in one line and with exit code 2.

#include "command.hpp"
#include <gonio/core/error.hpp>

#include <exception>
#include <iostream>
#include <new>

namespace {

constexpr int bad_input = 2;
constexpr int failure = 1;

int complain(const std::string& what, int code) {
  std::cerr << "gonio: " << what << '\n';
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"gonio completes a BRDF from a few reflectance measurements.", "gonio"};
  app.set_version_flag("--version", GONIO_VERSION);
  app.require_subcommand(1);
  cli::add_learn(app);
  cli::add_expand(app);
  cli::add_design(app);
  cli::add_plan(app);
  cli::add_sample(app);
  cli::add_near_field(app);
  cli::add_reconstruct(app);
  cli::add_fit(app);
  cli::add_compare(app);
  cli::add_render(app);
  cli::add_info(app);
  cli::add_lab(app);
  cli::add_shape(app);
  cli::add_evaluate(app);
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::Success& request) {  // --help and --version
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    return complain(std::string(error.what()) + " (gonio --help shows the usage)", bad_input);
  } catch (const gonio::error& error) {
    return complain(error.what(), bad_input);
  } catch (const std::bad_alloc&) {
    return complain("there is not enough memory", failure);
  } catch (const std::exception& error) {
    return complain(error.what(), failure);
  }
}
