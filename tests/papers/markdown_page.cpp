/// gonio-papers --markdown: what is printed replaces a block of a page.

#include "../io/scratch.hpp"
#include "papers_tool.hpp"
#include "synthetic_networks.hpp"
#include <gonio/evaluate/test_materials.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

namespace {

const std::string before = "# A page\n\nTwo `<!-- gonio-papers -->` lines; \xc3\xa4\n\n";
const std::string after = "\n| hand | written |\n\r\n<!-- end of gonio-papers -->\nno newline at the end";

std::string page_with(const std::string& command, const std::string& content) {
  return before + "<!-- " + command + " -->\n" + content + "<!-- end of gonio-papers -->\n" + after;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Lines of prose are wrapped where they are too long.
std::string unwrapped(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

/// A folder with networks, and a page with a block for `eta` on them.
struct eta_page {
  eta_page() {
    std::vector<std::string> names = gonio::nielsen_test_materials();
    for (const char* name : {"a", "b", "c", "d", "e", "f"}) names.emplace_back(name);
    write_synthetic_networks(folder, names);
    scratch::put(path, old);
  }

  [[nodiscard]] tool_result run(const std::string& options) const {
    return gonio_papers("eta --thin 3 5 --networks " + (folder / "n.npy").string() + " " + options);
  }

  scratch::folder folder;
  scratch::fs::path path = folder / "page.md";
  std::string command = "gonio-papers eta --thin 3 5 --networks n.npy -n 5 --noise 0.1 --sets published";
  std::string old = page_with(command, "old\n| old |\n");
  std::string page = " --markdown " + path.string();
};

}  // namespace

TEST_CASE("a block is replaced, and nothing else of the page") {
  const eta_page at;
  const auto printed = at.run("-n 5 --noise 0.1 --threads 2" + at.page + " --sets published");
  REQUIRE_MESSAGE(printed.exit_code == 0, printed.output);
  const std::string page = scratch::get(at.path);
  CAPTURE(page);
  const std::string head = before + "<!-- " + at.command + " -->\n";
  const std::string tail = "<!-- end of gonio-papers -->\n" + after;
  REQUIRE(page.size() > head.size() + tail.size());
  CHECK(page.starts_with(head));
  CHECK(page.ends_with(tail));
  const std::string block = page.substr(head.size(), page.size() - head.size() - tail.size());
  CHECK(has(block, "\n| published | 5 | 10 % | "));
  CHECK_FALSE(has(block, "old"));
  // The same appears on standard output, and the last line says where it is from.
  CHECK(has(printed.output, block.substr(block.find("\n| "), 80)));
  CHECK(has(block, "\nPrinted on 20"));
  CHECK(has(unwrapped(block), " by `" + at.command + "`, gonio "));
  CHECK(has(unwrapped(block), ", 2 threads"));
  CHECK(block.ends_with(" s.\n"));

  // The same again in its own block, but for the time.
  REQUIRE(at.run("-n 5 --noise 0.1 --threads=1" + at.page + " --sets published").exit_code == 0);
  const std::string again = scratch::get(at.path);
  CHECK(again.substr(0, again.find("Printed on")) == page.substr(0, page.find("Printed on")));
  CHECK(has(unwrapped(again), ", 1 thread"));
}

TEST_CASE("a page without such a block is refused before the work") {
  const eta_page at;
  const auto refuses = [&](const std::string& options, std::initializer_list<std::string> words) {
    const auto refused = at.run(options);
    CAPTURE(refused.output);
    CHECK(refused.exit_code == 2);
    CHECK(refused.output.find('\n') == refused.output.size() - 1);
    for (const std::string& word : words) CHECK(has(refused.output, word));
    CHECK(scratch::get(at.path) == at.old);
  };
  refuses("-n 10" + at.page, {"page.md", "has no block for `gonio-papers eta --thin 3 5 --networks n.npy -n 10`"});
  refuses("--markdown " + (at.folder / "other.md").string(), {"other.md", "No such file"});
  refuses("--markdown " + (at.folder / "page.txt").string(), {"page.txt", ".md"});

  scratch::put(at.folder / "open.md", "<!-- gonio-papers model-properties -->\n| a |\n");
  scratch::put(at.folder / "twice.md", at.old + "\n" + at.old);
  scratch::put(at.folder / "next.md",
               "<!-- gonio-papers model-properties -->\n<!-- x -->\n<!-- end of x -->\n"
               "<!-- end of gonio-papers -->\n");
  for (const char* name : {"open.md", "next.md"}) {
    const auto refused = gonio_papers("model-properties --markdown " + (at.folder / name).string());
    CHECK(refused.exit_code == 2);
    CHECK(has(refused.output, "has no block"));
  }
  refuses("-n 5 --noise 0.1 --sets published --markdown " + (at.folder / "twice.md").string(),
          {"twice.md", "more than one block"});
}

TEST_CASE("a failed or killed experiment leaves the page as it was") {
  const eta_page at;
  const std::string absent = page_with("gonio-papers eta --networks absent.npy", "old\n");
  scratch::put(at.path, absent);
  const auto failed = gonio_papers("eta --networks " + (at.folder / "absent.npy").string() + at.page);
  CHECK(failed.exit_code == 2);
  CHECK(has(failed.output, "absent.npy"));
  CHECK(scratch::get(at.path) == absent);

  scratch::put(at.path, at.old);
  const std::string killed = "timeout -s KILL 0.2 '" GONIO_PAPERS "' eta --thin 3 5 --networks " +
                             (at.folder / "n.npy").string() + " -n 5 --noise 0.1 --sets published" + at.page;
  CHECK(run_program("sh", "-c \"" + killed + "\"").exit_code != 0);
  CHECK(scratch::get(at.path) == at.old);
  CHECK(at.folder.entries() == 3);
}

TEST_CASE("the table of another program") {
  const scratch::folder folder;
  const std::string page = (folder / "page.md").string();
  scratch::put(page, "<!-- printf | a |\\n -->\n<!-- end of printf -->\n");
  const auto printed = gonio_papers("run --markdown " + page + " -- /usr/bin/printf '| a |\\n'");
  REQUIRE_MESSAGE(printed.exit_code == 0, printed.output);
  CHECK(scratch::get(page).starts_with("<!-- printf | a |\\n -->\n\n| a |\n\nPrinted on 20"));
  scratch::put(folder / "false.md", "<!-- false -->\n<!-- end of false -->\n");
  CHECK(gonio_papers("run --markdown " + (folder / "false.md").string() + " -- false").exit_code == 2);
  CHECK(scratch::get(folder / "false.md") == "<!-- false -->\n<!-- end of false -->\n");
}

TEST_CASE("long tables are folded, short ones are not") {
  const scratch::folder folder;
  const std::string page = (folder / "page.md").string();
  const auto printed_rows = [&](int rows) {
    std::string text = "Before.\n\n| a | b | c | d |\n|---|---|---|---|\n";
    for (int i = 0; i < rows; ++i) text += "| 1 | 2 | 3 | 4 |\n";
    scratch::put(folder / "text", text + "\nAfter.\n");
    scratch::put(page, "<!-- cat text -->\n<!-- end of cat -->\n");
    const auto printed = gonio_papers("run --markdown " + page + " -- cat " + (folder / "text").string());
    REQUIRE_MESSAGE(printed.exit_code == 0, printed.output);
    CHECK_FALSE(has(printed.output, "details"));
    return scratch::get(page);
  };
  CHECK_FALSE(has(printed_rows(25), "details"));
  const std::string long_page = printed_rows(26);
  CHECK(has(long_page,
            "Before.\n\n<details markdown=\"1\">\n<summary>26 rows: a, b, c, ...</summary>\n\n| a | b | c | d |\n"));
  CHECK(has(long_page, "| 1 | 2 | 3 | 4 |\n\n</details>\n\nAfter.\n\nPrinted on 20"));
}
