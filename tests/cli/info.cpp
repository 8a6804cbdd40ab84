/// gonio info: the kind of a file and facts about it. Files of other programs are accepted wherever samples are read.

#include "../io/scratch.hpp"
#include "../json.hpp"
#include "tool.hpp"

#include <doctest/doctest.h>

#include <string>

namespace {

struct folder_of_files {
  scratch::folder folder;

  [[nodiscard]] std::string put(const std::string& name, const std::string& content) const {
    scratch::put(folder / name, content);
    return (folder / name).string();
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder / name).string(); }
};

/// Returns the facts about a file, without the warnings above them.
auto facts_of_file(const std::string& path, const std::string& options = "") {
  const auto result = gonio_tool("info --json " + path + options);
  CAPTURE(result.output);
  REQUIRE(result.exit_code == 0);
  return read_json(result.output.substr(result.output.find('{')));
}

const std::string zemax_file =
    "# made up\nSource Measured\nSymmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterType BRDF\n"
    "SampleRotation 1\n0\nAngleOfIncidence 2\n20 40\nScatterAzimuth 3\n0 90 180\nScatterRadial 3\n0 20 30\n\n"
    "Monochrome\nDataBegin\nTIS 0.5\n.5 .4 .3\n.5 .4 .3\n.5 .4 .3\nTIS 0.5\n.6 .5 .4\n.6 .5 .4\n.6 .5 .4\nDataEnd\n";
const std::string astm_file =
    "NUM_POINTS 3\nVARS theta_i,phi_i,theta_s,phi_s,R,G,B\n0.5,0,0.25,3.1,.1,.2,.3\n0.5,0,0.75,1,.1,.2,.3\n"
    "0.1,0,0.75,2,.1,.2,.4\n";
const std::string ssdd_file =
    "VERSION 0.3\nDATA_TYPE brdf\nCOLOR_MODEL monochrome\nPARAM_TYPE spherical_coordinate_system\nPARAM0_LIST 10 40\n"
    "PARAM2_LIST 20\nPARAM3_LIST 0 90 180\nDATA ascii\n.1\n.2\n.3\n.4\n.5\n.6\n";
const std::string bird_json =
    "{\"metadata\":{\"instrumentation\":{\"detection_system\":{\"solid_angle\":{\"value\":0.002194,\"unit\":\"sr\"}}}},"
    "\"data\":{\"theta_i\":{\"unit\":\"deg\",\"values\":[10,20,30]},\"phi_i\":{\"unit\":\"deg\","
    "\"values\":[0,0,0]},\"theta_r\":{\"unit\":\"deg\",\"values\":[40,50,60]},\"phi_r\":{\"unit\":\"deg\",\"values\":"
    "[180,90,45]},\"BRDF\":{\"unit\":\"sr^-1\",\"values\":[0.1,0.2,0.3]}}}";

}  // namespace

TEST_CASE("info knows the files of other programs by how they begin, and reconstruct and fit read them") {
  const folder_of_files given;
  const auto check = [&](const std::string& name, const std::string& content, const std::string& format, int samples) {
    const std::string path = given.put(name, content);
    const auto facts = facts_of_file(path);
    CHECK(facts["kind"] == "samples");
    CHECK(facts["format"] == format);
    CHECK(facts["samples"] == samples);
    const auto fitted = gonio_tool("reconstruct " + path + " -o " + given.at("out.binary"));
    CAPTURE(fitted.output);
    CHECK(fitted.exit_code == 0);
    CHECK(fitted.output.find(std::to_string(samples) + " samples") != std::string::npos);
    CHECK(gonio_tool("fit " + path + " --model lambert").exit_code == 0);
  };
  check("vinyl.bsdf", zemax_file, "Zemax BSDF", 14);
  check("vinyl.measured", zemax_file, "Zemax BSDF", 14);
  check("paint.astm", astm_file, "ASTM E1392", 3);
  check("metal.ssdd", ssdd_file, "SSDD", 6);
  check("tile.brdf", bird_json, "BiRD", 3);
  check("tile.json", bird_json, "BiRD", 3);
  CHECK(facts_of_file(given.at("tile.json"))["receiver_half_angle"][0] == doctest::Approx(1.514).epsilon(1e-3));
  check(
      "tape.dat",
      "#DIM 3 1\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n#PARAM_OUT INV_STERADIAN\n0.5 0.5 3.1 .2\n0 0.5 0 .1\n1 0.5 3.1 .1\n",
      "ALTA", 3);
  check("blind.xml",
        "<WindowElement><DataDefinition><IncidentDataStructure>Columns</IncidentDataStructure><AngleBasis>"
        "<AngleBasisName>k</AngleBasisName><AngleBasisBlock><Theta>40</Theta><nPhis>2</nPhis></AngleBasisBlock>"
        "</AngleBasis></DataDefinition><WavelengthData><Wavelength>Visible</Wavelength><WavelengthDataBlock>"
        "<WavelengthDataDirection>Reflection Front</WavelengthDataDirection><ColumnAngleBasis>k</ColumnAngleBasis>"
        "<RowAngleBasis>k</RowAngleBasis><ScatteringData>.2, .1, .1, .2</ScatteringData></WavelengthDataBlock>"
        "</WavelengthData></WindowElement>",
        "Klems matrix", 4);
  const std::string tree =
      "<DataDefinition><IncidentDataStructure>TensorTree3</IncidentDataStructure></DataDefinition>"
      "<WavelengthData><Wavelength>Visible</Wavelength><WavelengthDataBlock><WavelengthDataDirection>Reflection Back"
      "</WavelengthDataDirection><AngleBasis>LBNL/Shirley-Chiu</AngleBasis><ScatteringData>{ .25 }</ScatteringData>"
      "</WavelengthDataBlock></WavelengthData></WindowElement>";
  check("tree.xml", "<WindowElement>" + tree, "tensor tree", 256);
  // The tree may be preceded by a long list of geometry.
  CHECK(gonio_tool("info --side back --band visible " + given.at("tree.xml")).exit_code == 0);
  const auto no_front = gonio_tool("info --side front " + given.at("tree.xml"));
  CHECK(no_front.exit_code == 2);
  CHECK(no_front.output.find("has no 'Reflection Front'") != std::string::npos);
  for (const std::string other : {"tape.dat", "s.csv"}) {
    if (other == "s.csv") static_cast<void>(given.put(other, "theta_h,theta_d,phi_d,r,g,b\n1,2,3,1,1,1\n"));
    const auto refused = gonio_tool("info --band Solar " + given.at(other));
    CHECK(refused.exit_code == 2);
    CHECK(refused.output.find("--side and --band need a Klems matrix") != std::string::npos);
  }
  const std::string room = "<WindowElement><Geometry>" + std::string(70'000, ' ') + "</Geometry>" + tree;
  CHECK(facts_of_file(given.put("room.xml", room))["samples"] == 256);
  check("paint.brdf",
        "OPTIS - brdf surface file v9.0\n0\npaint\n0\n\n1\t0\n1\n1 1\n30\n550\n50\n3 3\n\t0 180 360\n0 1 1 1\n"
        "40 2 1 2\n90 1 1 1\n",
        "Speos", 3);
  check("diffuser.bsdf",
        "Symmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterAzimuth 2\n90 270\nScatterRadial 2\n10 40\n"
        "DataBegin\nAOI 30\nPOI 0\nSide Front\nWavelength 550\nScatterType BRDF\nTIS 0.5\n.1 .1\n.2 .3\nDataEnd\n",
        "LightTools BSDF", 4);
  check("black.jdv",
        "DataType:\tBRDF(RT-300S)\t\t\rIncidence:\t30\t\t\rRaw data\t\t\t\r\t-30\t0\t30\r-90\t10\t11\t12\r", "RT-300S",
        3);
  check("black.tsv",
        " Method\tBRDF_LD\tBRDF_LD\tBRDF_LD\n Azimuth\t-90\t-90\t0\n Incidence\t30\t30\t30\n"
        " Receive\t-30\t0\t30\n RT\t.1\t.11\t.12\n",
        "RT-300S", 3);
  check("black.txt", "type bsdf_data\nformat angles=deg bsdf=value scale=1\n10\t0\n0\t0\t.1\n10\t0\t.2\n20\t90\t.1\n",
        "FRED", 3);
  check("spectra.brdf", "2\n450 650\n0.5 0 0.4 3 .1 .2\n0.1 0 0.4 2 .1 .2\n0.2 0 0.5 1 .1 .3\n",
        "spectral samples of Cornell", 3);
}

TEST_CASE("info says ranges of angles, repeats, weights, and what is suspicious") {
  const folder_of_files given;
  const auto facts = facts_of_file(given.put("s.csv",
                                             "theta_i,phi_i,theta_o,phi_o,r,g,b,weight\n10,0,20,180,1,1,1,1\n"
                                             "10,0,20,180,4,4,4,0\n30,0,88,180,-1,1,1,2\n30,0,10,180,4,4,4,1\n"));
  CHECK(facts["samples"] == 4);
  CHECK(facts["theta_i"][0] == 10.0);
  CHECK(facts["theta_i"][1] == 30.0);
  CHECK(facts["theta_o"][1] == 88.0);
  CHECK(facts["theta_h"][0] == 5.0);
  CHECK(facts["theta_d"][1] == 59.0);
  CHECK(facts["repeated_directions"] == 1);
  CHECK(facts["samples_with_negative_values"] == 1);
  CHECK(facts["weights"][0] == 0.0);
  CHECK(facts["weights"][1] == 2.0);
  const std::string suspicions = facts["suspicious"].dump();
  CHECK(suspicions.find("plane of incidence") != std::string::npos);
  CHECK(suspicions.find("1 of 4 samples has a negative value") != std::string::npos);
  CHECK(suspicions.find("1 sample is more than 85 degrees from the normal") != std::string::npos);
  CHECK(facts_of_file(GONIO_SOURCE_DIR "/examples/data/measurements.csv")["suspicious"].empty());
}

TEST_CASE("info says how it read a file of samples, with the options that say the same") {
  const folder_of_files given;
  const std::string scan = given.put("scan.csv",
                                     "theta_i;theta_o;percent\n0;30;11,87\n0;-30;11,87\n30;-30;80,5\n30;0;11,9\n"
                                     "60;-60;90,1\n60;90;0\n");
  const auto facts = facts_of_file(scan);
  CHECK(facts["read_as"] ==
        "5 samples in the plane of incidence; theta_i 0, 30, 60 degrees; theta_o -60 to 30 degrees, negative on the "
        "mirror direction's side; one channel, percent of a white diffuser; semicolon-separated with decimal commas; 1 "
        "row without a reading omitted");
  CHECK(facts["options"] == "--quantity percent --theta-o-sign light");
  REQUIRE(facts["unsure_of"].size() == 1);
  CHECK(facts["unsure_of"][0].get<std::string>().find("--theta-o-sign mirror") != std::string::npos);
  CHECK(gonio_tool("info " + scan).output.find("read_as: 5 samples in the plane") != std::string::npos);
  // A sign stated by an option is no longer reported as uncertain.
  const auto stated = facts_of_file(scan, " --theta-o-sign light");
  CHECK(stated["options"] == "--quantity percent --theta-o-sign light");
  CHECK(stated["unsure_of"].empty());

  const auto colours = facts_of_file(
      given.put("rgb.csv", "theta_i,phi_i,theta_o,phi_o,r,g,b\n10,0,20,90,1,1,1\n30,0,40,180,.2,.2,.3\n"));
  CHECK(colours["read_as"] ==
        "2 samples; theta_i 10, 30 degrees; theta_o up to 40 degrees; red, green and blue, BRDF in "
        "sr^-1; comma-separated with decimal points");

  const auto one_angle = facts_of_file(given.put("one.csv", "theta_i;theta_o;percent\n45;-45;11,87\n"));
  CHECK(one_angle["read_as"].get<std::string>().starts_with(
      "1 sample in the plane of incidence; theta_i 45 degrees; theta_o -45 degrees, negative on the"));
}

TEST_CASE("info knows each other kind of file that gonio reads or writes") {
  const folder_of_files given;
  const auto kind = [](const std::string& path) { return facts_of_file(path)["kind"]; };
  const std::string table = given.at("t.binary"), spheres = given.at("s.png");
  REQUIRE(gonio_tool("expand --formula red-paint -o " + table).exit_code == 0);
  CHECK(kind(table) == "MERL table");
  std::filesystem::copy_file(table, given.at("nameless"));
  CHECK(kind(given.at("nameless")) == "MERL table");
  REQUIRE(gonio_tool("render --size 16 " + table + " -o " + spheres).exit_code == 0);
  CHECK(kind(spheres) == "PNG image");
  REQUIRE(gonio_tool("expand --formula red-paint -o " + given.at("t.npy")).exit_code == 0);
  CHECK(kind(given.at("t.npy")) == "table as an array");
  const auto plan = facts_of_file(GONIO_SOURCE_DIR "/examples/data/nielsen-20.csv");
  CHECK(plan["kind"] == "directions");
  CHECK(plan["directions"] == 20);
  CHECK(kind(given.put("d.csv", "theta_i;phi_i;theta_o;phi_o\n10,5;0;20;180\n")) == "directions");
  CHECK(kind(given.put("e.csv", "file,seconds\na.png,1/250\nb.png,2\n")) == "exposure times");
  CHECK(kind(given.put("w.csv", "theta_i,factor\n0,0.99\n45,0.98\n")) == "reflectance of a white reference");
  CHECK(kind(given.put("a.txt", "light 0 70\nforbid 0 10 0 10\n")) == "an apparatus");
  CHECK(kind(given.put("n.txt", "size 4 4\nposition 0 0 1\n")) == "set-up of an image");
  CHECK(kind(given.put("p.pgm", std::string("P5 2 1 255\n\x01\xFF", 13))) == "Netpbm image");
  CHECK(kind(given.put("m.ply", "ply\nformat ascii 1.0\n")) == "mesh (PLY)");
  CHECK(kind(given.put("m.obj", "v 0 0 0\n")) == "mesh (OBJ)");
  CHECK(kind(given.put("m.json",
                       "{\"largest_count\":255,\"frames\":[{\"theta_i\":10,\"phi_i\":0,\"theta_o\":20,\"phi_o\":0,"
                       "\"seconds\":1,\"file\":\"a.png\"}]}")) == "recorded frames");
}

TEST_CASE("info does not guess: what it does not know it says so") {
  const folder_of_files given;
  const auto refuses = [](const std::string& path, const char* why) {
    const auto result = gonio_tool("info " + path);
    CAPTURE(result.output);
    CHECK(result.exit_code == 2);
    CHECK(result.output.find(why) != std::string::npos);
  };
  refuses("/etc/passwd", "unknown kind of file");
  refuses(GONIO_SOURCE_DIR "/README.md", "unknown kind of file");
  refuses(given.put("noise", std::string(5000, '\x07')), "unknown kind of file");
  refuses(given.put("empty.dat", ""), "unknown kind of file");
  refuses(given.put("damaged.bsdf", zemax_file.substr(0, zemax_file.size() - 30)), "ends before BRDF");
  refuses(given.put("cut.binary", std::string("\x5A\0\0\0\x5A\0\0\0\xB4\0\0\0", 12)), "cut.binary");
  refuses(given.put("other.bsdf", "tensor_file"), "other.bsdf");
}

TEST_CASE("a shipped file is named by its path in examples/data, wherever a prior or directions are read") {
  const folder_of_files given;
  const std::string data = std::string(GONIO_SOURCE_DIR) + "/examples/data/";
  const std::string set = "directions/point-20-published.csv";
  CHECK(run("info --json shipped:materials.prior") == run("info --json " + data + "materials.prior"));
  CHECK(run("info --json shipped:" + set) == run("info --json " + data + set));
  CHECK(run("plan shipped:" + set) == run("plan " + data + set));
  refuses("plan shipped:directions/none.csv", {"directions/none.csv", "No such file"});
  refuses("info --components none.png shipped:none.prior", {"none.prior", "No such file"});

  run("expand --name blue-rubber --prior shipped:materials.prior -o " + given.at("one.binary"));
  run("expand --name blue-rubber -o " + given.at("other.binary"));
  CHECK(scratch::get(given.folder / "one.binary") == scratch::get(given.folder / "other.binary"));
  run("sample " + given.at("one.binary") + " --directions shipped:" + set + " -o " + given.at("one.csv"));
  run("sample " + given.at("one.binary") + " --directions " + data + set + " -o " + given.at("other.csv"));
  CHECK(scratch::get(given.folder / "one.csv") == scratch::get(given.folder / "other.csv"));
}
