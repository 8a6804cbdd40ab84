/// Bad input gives exit code 2 and one clear line, and leaves existing files unchanged.

#include "../io/scratch.hpp"
#include "tool.hpp"

#include <doctest/doctest.h>

#include <algorithm>

TEST_CASE("help is no error") {
  for (const char* command : {"", "learn ", "expand ", "design ", "plan ", "sample ", "near-field ", "reconstruct ",
                              "fit ", "compare ", "render ", "properties ", "info "}) {
    const auto result = gonio_tool(std::string(command) + "--help");
    CHECK(result.exit_code == 0);
    CHECK(result.output.size() > 100);
  }
  CHECK(gonio_tool("--version").exit_code == 0);
}

TEST_CASE("wrong command lines") {
  refuses("reconstruckt x", {"'reconstruckt' is no subcommand of gonio: did you mean reconstruct?"});
  refuses("frobnicate x", {"'frobnicate' is no subcommand of gonio (gonio --help lists them)"});
  refuses("lab paln x", {"'paln' is no subcommand of gonio lab: did you mean plan?"});
  refuses("design -n -3", {"--count: -3 is not a number of at least 0 (gonio design --help"});
  refuses("design -n 2 --geomtry point", {"'--geomtry' is no option of gonio design: did you mean --geometry?"});
  refuses("design -n 2 --frobnicate=3",
          {"'--frobnicate' is no option of gonio design (gonio design --help lists them)"});
  refuses("plan d.csv -o plan.csv", {"'-o' is no option of gonio plan (gonio plan --help lists them)"});
  refuses("lab scan -q", {"'-q' is no option of gonio lab scan (gonio lab scan --help lists them)"});
  refuses("sample", {"table"});
  refuses("expand -o x.binary", {"--networks", "--formula"});
  refuses("expand --name no-such-stone -o x.binary", {"no-such-stone", "materials.prior"});
  refuses("expand --formula no-such-paint -o x.binary", {"no-such-paint", "red-paint"});
  refuses("learn -o x.prior", {"--networks", "--merl"});
  refuses("learn --merl /no/such/folder -o x.prior", {"/no/such/folder"});
  refuses("learn --networks /no/such/file.npy -o x.prior", {"/no/such/file.npy"});
}

TEST_CASE("bad samples") {
  const scratch::folder folder;
  const auto path = folder / "bad.csv";
  const std::string reconstruct = "reconstruct " + path.string() + " -o " + (folder / "out.binary").string();
  const auto with = [&](const std::string& content, std::initializer_list<const char*> words) {
    scratch::put(path, content);
    refuses(reconstruct, words);
    CHECK_FALSE(std::filesystem::exists(folder / "out.binary"));
  };
  const std::string header = "theta_h,theta_d,phi_d,r,g,b\n";
  with("", {"bad.csv"});
  with(header, {"bad.csv"});
  with(header + "1,2,3,0.1,nan,0.1\n", {"bad.csv", "line 2", "nan"});
  with(header + "1,2,3,0.1,0.1,0.1\n80,80,0,0.1,0.1,0.1\n", {"line 3", "horizon"});
  with("theta_h,theta_d,phi_d,r,g,colour\n1,2,3,1,1,1\n", {"'b' is missing", "'colour'"});
  with("theta_h,theta_d,phi_d,r,g\n1,2,3,1,1\n", {"b"});
  with(header + "1,2,3,0.1,0.1\n", {"line 2"});
  scratch::put(path, header + "1,2,3,0.1,0.1,0.1\n");
  refuses(reconstruct + " --eta 0", {"eta"});
  refuses(reconstruct + " --eta -3", {"eta"});
  refuses(reconstruct + " --eta much", {"eta", "gcv", "much"});
  refuses(reconstruct + " --eta gcv", {"2 rows", "not 1"});  // one observation: nothing left to validate with
  refuses(reconstruct + " --noise -0.1", {"noise", "negative", "-0.1"});
  refuses(reconstruct + " --noise much", {"--noise", "much"});
  refuses(reconstruct + " --noise 0.1 --eta 3", {"--noise", "--eta", "one of them"});
  refuses(reconstruct + " --noise 0.1 --solver lasso", {"--noise", "tikhonov", "lasso"});
  refuses(reconstruct + " --discrepancy 0.1 --eta 3", {"--discrepancy", "--eta"});
  refuses(reconstruct + " --discrepancy -1", {"--discrepancy", "-1"});
  refuses(reconstruct + " --discrepancy 0 --no-reject", {"--no-reject", "need a discrepancy"});
  refuses(reconstruct + " --eta 3 --uncertainty " + (folder / "u.binary").string(), {"--uncertainty", "--eta"});
  refuses(reconstruct + " --residuals " + (folder / "r.txt").string(), {"--residuals", ".csv"});
  refuses(reconstruct + " --method linear --no-reject", {"--no-reject", "--method pca"});
  refuses(reconstruct + " --noise 0.1 --method linear", {"--noise", "linear", "--method pca"});
  refuses(reconstruct + " --solver magic", {"magic"});
  refuses(reconstruct + " --solver nnls", {"nnls", "signs", "--method linear"});
  refuses(reconstruct + " --metric log", {"log", "--method linear"});
  refuses(reconstruct + " --exclude chrome", {"--method linear"});
  for (const char* method : {"rbf", "pull-push", "scattered", "soft-specular"})
    for (const char* option : {"--networks", "--merl", "--rgl", "--exclude"})
      refuses("reconstruct " + path.string() + " --method " + method + ' ' + option + " elsewhere",
              {option, "needs --method pca or linear or correction"});
  const std::string linear = reconstruct + " --method linear";
  refuses(linear + " --exclude no-such-stone", {"no-such-stone"});
  refuses(linear + " --metric cosine", {"cosine"});
  refuses(linear + " --metric root --root 0.5", {"0.5"});
  refuses(linear + " --solver lasso --lambda 2", {"lambda", "2"});
  refuses(linear + " --solver tsvd --variance 0", {"variance"});
  refuses(linear + " --networks a.npy --merl b", {"a.npy", "No such file"});
  std::filesystem::create_directory(folder / "empty");
  refuses(linear + " --merl " + (folder / "empty").string(), {"empty: holds no MERL table"});
  refuses("reconstruct", {"samples", "gonio reconstruct --help"});
  refuses(linear + " --rgl " + folder.path().string(),
          {folder.path().c_str(), "holds no material of the RGL database (.bsdf)"});
  refuses(reconstruct + " --prior " + path.string(), {"not a gonio prior"});
  refuses("reconstruct " + folder.path().string() + " -o x.binary", {folder.path().c_str()});
  refuses("reconstruct /no/such.csv -o x.binary", {"/no/such.csv"});
}

TEST_CASE("samples that are likely to disappoint are accepted with a warning") {
  const scratch::folder folder;
  const auto warns = [&](const std::string& lines, const std::string& options,
                         std::initializer_list<const char*> words) {
    const std::string file = (folder / "samples.csv").string();
    scratch::put(file, "theta_i,phi_i,theta_o,phi_o,r,g,b\n" + lines);
    const auto result = gonio_tool("reconstruct " + file + options);
    CAPTURE(result.output);
    CHECK(result.exit_code == 0);
    for (const char* word : words)
      CHECK(result.output.find(std::string("gonio: warning: ") + word) != std::string::npos);
  };
  const std::string around = "20,0,40,90,.3,.3,.3\n30,0,10,60,.2,.2,.2\n50,0,20,130,.1,.1,.1\n";
  warns(around, " --noise 0.6", {"noise of 60 % is very large: do you mean 0.60 %, --noise 0.0060?"});
  warns("30,0,30,180,.2,.2,.2\n" + around + "30,0,30,180,.8,.8,.8\n", "",
        {"samples 1 and 5 have the same directions, but the values 0.200 and 0.800"});
  warns("30,0,30,180,.0001,.0002,.1\n" + around + "30,0,30,180,.0001,.0009,.1\n", "",
        {"samples 1 and 5 have the same directions, but the values 0.0002 and 0.0009 (green)"});
  warns("30,0,30,180,.2,.2,.2\n30,0,10,180,.1,.1,.1\n30,0,50,0,.1,.1,.1\n", "",
        {"all samples are in the plane of incidence", "the highlight is known to a factor of "});
  warns("20,0,40,90,.3,.3,.3\n30,0,10,60,.3,.3,.3\n50,0,20,130,.3,.3,.3\n", " --method pull-push",
        {"all samples have the same value"});
  warns("20,0,40,90,.3,.3,.3\n", " --noise 0", {"the highlight is known to a factor of "});
  std::string flat;
  for (const std::string theta : {"8", "9", "10", "11"}) flat += "10,0," + theta + ",180,.4,.4,.4\n";
  warns(flat + around, "", {"4 samples have exactly the largest value, 0.4000: was the detector saturated?"});
  warns(around + "20,0,20,90,-.1,-.1,-.1\n20,0,30,90,-.1,-.1,-.1\n20,0,50,90,-.2,-.2,-.2\n20,0,60,90,-.2,-.2,-.2\n", "",
        {"4 of 7 samples are negative: was the subtracted dark signal too large?"});
  scratch::put(folder / "dark.csv", "theta_i,phi_i,theta_o,phi_o,r,g,b\n20,0,20,90,-.1,-.1,-.1\n20,0,30,90,0,0,0\n");
  refuses("reconstruct " + (folder / "dark.csv").string(),
          {"dark.csv", "none of 2 samples reflects light", "dark signal"});
}

TEST_CASE("options of one method given to another") {
  const scratch::folder folder;
  const auto path = folder / "one.csv";
  scratch::put(path, "theta_h,theta_d,phi_d,r,g,b\n1,2,3,0.1,0.1,0.1\n");
  const std::string start = "reconstruct " + path.string() + " -o " + (folder / "out.binary").string() + " --method ";
  refuses(start + "linear --gamma 3", {"--gamma", "--method linear", "--method correction"});
  refuses(start + "pca --history h.csv", {"--history", "--method pca", "--method correction"});
  refuses(start + "pca --neighbours 3", {"--neighbours", "--method pca", "--method scattered"});
  refuses(start + "rbf --iterations 3", {"--iterations", "--method correction"});
  refuses(start + "pull-push --iteration-figure " + (folder / "story").string(),
          {"--iteration-figure", "--method correction"});
  refuses(start + "correction --solver nnls", {"--solver", "pca or linear"});
  // Refuses an option of a solver or metric that is not in use, because it would have no effect.
  for (const auto& [options, sentence] : std::initializer_list<std::pair<const char*, const char*>>{
           {"pca --root 2", "--root needs --metric root"},
           {"pca --variance 0.5", "--variance needs --solver tsvd, not tikhonov"},
           {"pca --lambda 0.5", "--lambda needs --solver lasso, not tikhonov"},
           {"pca --solver ls --eta 3", "--eta needs --solver tikhonov, not ls"},
           {"linear --eta gcv", "--eta needs --solver tikhonov, not nnls"},
           {"linear --metric log --root 3", "--root needs --metric root"},
           {"rbf --root 3", "--root needs --metric root"}})
    refuses(start + options, {sentence});
  refuses(start + "rbf --eta 3", {"--eta", "pca or soft-specular or linear"});
  refuses(start + "soft-specular --solver nnls", {"--solver", "pca or linear"});
  refuses(start + "soft-specular --uncertainty u.binary", {"--uncertainty", "--method pca"});
  refuses(start + "rbf --exclude chrome", {"--exclude", "linear"});
  refuses(start + "pull-push --metric log", {"--metric", "rbf"});
  refuses(start + "linear --seed 3", {"--seed", "correction or rbf"});
  refuses(start + "magic", {"magic", "pull-push"});
  CHECK(folder.entries() == 1);
}

TEST_CASE("bad requests of the correction method") {
  const scratch::folder folder;
  const auto path = folder / "one.csv", story = folder / "story";
  scratch::put(path, "theta_h,theta_d,phi_d,r,g,b\n1,2,3,0.1,0.1,0.1\n");
  const std::string correction =
      "reconstruct " + path.string() + " -o " + (folder / "out.binary").string() + " --method correction ";
  for (const char* gamma : {"-1", "much", "nan", "inf", "3x", "''"})
    refuses(correction + "--gamma " + gamma, {"--gamma", "auto"});
  for (const char* count : {"0", "-1", "2.5", "many"})
    refuses(correction + "--iterations " + count, {"--iterations", count});
  refuses(correction + "--truth " + path.string(), {"--truth", "--iteration-figure"});
  refuses(correction + "--truth " + path.string() + " --iteration-figure " + story.string(),
          {"one.csv", "expected a whole material"});
  refuses(correction + "--exclude no-such-stone --iteration-figure " + story.string(), {"no-such-stone"});
  refuses(correction + "--iteration-figure " + (path / "below-a-file").string(),
          {"below-a-file", "cannot create the folder"});
  CHECK(folder.entries() == 1);  // neither a table nor a folder of iteration figures
}

TEST_CASE("bad tables and requests of tables") {
  const scratch::folder folder;
  const std::string table = (folder / "t.binary").string(), out = " -o " + (folder / "out.csv").string();
  REQUIRE(gonio_tool("expand --formula blue-rubber -o " + table).exit_code == 0);
  refuses("sample " + table + " --count 0" + out, {"count"});
  refuses("sample " + table + " --count 100000000" + out, {"100000000"});
  refuses("sample " + table + " --ratio 1.5" + out, {"ratio"});
  refuses("sample " + table + " --count 5 --outliers 2" + out, {"outlier ratio"});
  refuses("sample " + table + " --count 5 --noise nan" + out, {"noise"});
  refuses("sample " + table + out, {"--count", "--ratio", "--directions"});
  std::filesystem::resize_file(table, 1'000'000);
  refuses("render " + table + " -o " + (folder / "x.png").string(), {"t.binary"});
  refuses("sample --count 3 " + table + " -o " + (folder / "x.csv").string(), {"t.binary"});
  refuses("info " + table, {"t.binary"});
  refuses("compare " + table + " " + table, {"t.binary"});
  CHECK(folder.entries() == 1);
}

TEST_CASE("an unwritable target or a full disk leaves the old file whole") {
  const scratch::folder folder;
  const auto old = folder / "old.binary";
  scratch::put(old, "precious");
  refuses("expand --formula red-paint -o " + (folder / "none" / "x.binary").string(), {"x.binary"});
  refuses("expand --formula red-paint -o " + folder.path().string(), {folder.path().c_str()});

  // A limit on file size stands in for a full disk: writing fails halfway through the 35 MB.
  const std::string limited = "sh -c 'trap \"\" XFSZ; ulimit -f 1024; exec \"$0\" \"$@\"' ";
  std::FILE* pipe =
      ::popen((limited + GONIO_TOOL + " expand --formula red-paint -o " + old.string() + " 2>&1").c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::string output(4096, '\0');
  output.resize(std::fread(output.data(), 1, output.size(), pipe));
  const int status = ::pclose(pipe);
  CAPTURE(output);
  CHECK(WEXITSTATUS(status) == 2);
  CHECK(output.find("old.binary") != std::string::npos);
  CHECK(scratch::get(old) == "precious");
  CHECK(folder.entries() == 1);
}
