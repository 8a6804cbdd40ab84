/// The `gonio` command-line tool.

#include "commands.hpp"

#include <string>
#include <vector>

namespace {

void list(cli::program& app) {
  app.list_subcommands("Measure", {{"design", "gonio design -n 20 -o twenty.csv"},
                                   {"plan", "gonio plan twenty.csv --image plan.png"},
                                   {"sample", "gonio sample red.binary --directions twenty.csv -o measurements.csv"},
                                   {"near-field", "gonio near-field flat.hdr setup.txt -o samples.csv"},
                                   {"sphere", "gonio sphere ball.hdr setup.txt -o samples.csv"}});
  app.list_subcommands("Reconstruct",
                       {{"reconstruct", "gonio reconstruct measurements.csv --noise 0.02 -o paint.binary"},
                        {"fit", "gonio fit measurements.csv --model ggx --mitsuba paint.xml"},
                        {"svbrdf", "gonio svbrdf images.json -o wood.gsv"}});
  app.list_subcommands("Judge", {{"report", "gonio report measurements.csv --noise 0.02 -o report.html"},
                                 {"check", "gonio check part.csv --reference measurements.csv --noise 0.02"},
                                 {"compare", "gonio compare paint.binary truth.binary"},
                                 {"properties", "gonio properties paint.binary"},
                                 {"texels", "gonio texels wood.gsv --uncertainty uncertainty.png"},
                                 {"info", "gonio info measurements.csv"}});
  app.list_subcommands("Use", {{"render", "gonio render paint.binary -o sphere.png"},
                               {"convert", "gonio convert paint.binary paint.bsdf"}});
  app.list_subcommands("Laboratory",
                       {{"lab", "gonio lab scan plan.csv --material red.binary -o paint.scan"},
                        {"lab plan", "gonio lab plan twenty.csv -o plan.csv"},
                        {"lab scan", "gonio lab scan plan.csv --material red.binary -o paint.scan"},
                        {"lab replay", "gonio lab replay frames.json -o paint.scan"},
                        {"lab calibrate", "gonio lab calibrate paint.scan --reference white.scan -o measurements.csv"},
                        {"lab probe", "gonio lab probe studio.hdr -o probe.hdr"},
                        {"lab unwrap", "gonio lab unwrap probe.hdr -o studio.hdr"},
                        {"lab photograph", "gonio lab photograph scene.hdr -o photographs"},
                        {"lab merge", "gonio lab merge photographs -o scene.hdr"}});
  app.list_subcommands("Materials, priors and shapes", {{"expand", "gonio expand --formula red-paint -o red.binary"},
                                                        {"learn", "gonio learn --merl tables -o my.prior"},
                                                        {"shape", "gonio shape --help"}});
}

}  // namespace

int main(int argc, char** argv) {
  cli::program app("gonio", "gonio completes a BRDF from a few reflectance measurements.", GONIO_VERSION);
  const cli::team alone;
  const std::vector<std::string> words(argv, argv + argc);
  cli::add_design(app, words, alone);
  cli::add_plan(app);
  cli::add_sample(app);
  cli::add_near_field(app);
  cli::add_sphere(app);
  cli::add_reconstruct(app, words);
  cli::add_report(app, words);
  cli::add_svbrdf(app, alone);
  cli::add_texels(app);
  cli::add_fit(app, words);
  cli::add_compare(app);
  cli::add_convert(app);
  cli::add_check(app, words);
  cli::add_render(app);
  cli::add_info(app);
  cli::add_properties(app);
  cli::add_lab(app);
  cli::add_learn(app, alone);
  cli::add_expand(app);
  cli::add_shape(app);
  list(app);
  app.greet_with(
      "gonio completes a BRDF from a few reflectance measurements.\n\n"
      "  gonio info scan.csv                          how the file is read\n"
      "  gonio reconstruct scan.csv -o paint.binary   the full table\n"
      "  gonio report scan.csv -o report.html         a page: how sure, which samples disagree\n\n"
      "gonio --help lists all subcommands, gonio SUBCOMMAND --help its options.");
  return app.run(argc, argv);
}
