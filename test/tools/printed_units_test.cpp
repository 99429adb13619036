// A terminal shows lengths and moduli in units that suit them, as the pages do.
#include <gtest/gtest.h>

#include <sstream>

#include "report/write_diagnosis.hpp"
#include "tools/estimate_recording.hpp"
#include "tools/formatted.hpp"
#include "tools/print_diagnosis.hpp"

namespace tissue_stiffness {
namespace {

// Of a body whose errors are `scale` times those of the demo.
Diagnosis damped(double scale) {
  Diagnosis d;
  d.verdict = Verdict::missing;
  d.final_verdict = Verdict::adequate;
  d.set = {"viscous_damping"};
  d.best = {{"viscous_damping"}, 0.91, 1.02e-4 * scale};
  MissingEffect damping, drift, untried;
  damping.effect = "viscous_damping";
  damping.explained = 0.91;
  damping.probability = 0.95;
  damping.z = 1.2;
  damping.held_out_rms_after = 1.02e-4 * scale;
  drift.effect = "rigid_drift";
  drift.held_out_rms_after = 3.1e-4 * scale;
  untried.effect = "gravity";
  d.candidates = {damping, drift, untried};
  d.where = "around (-3, 13, 41) mm: 5.3 sigma rms there";
  d.when = "early";
  d.force.words = "up to 30 N/kg, around (-15, 1, 38) mm along (0.67, -0.02, 0.74)";
  d.metres = {3.05e-4 * scale, 1e-4 * scale, 2.1e-5 * scale, 2.88e-4 * scale};
  d.steps = {
      {{}, {{"elasticity.young_modulus", 21467.5}}, 2.81e-4 * scale, 3.49e-4 * scale, 1e-4 * scale},
      {{"viscous_damping"}, {{"elasticity.young_modulus", 1.18631e6}}, 1.05e-4 * scale, 1.02e-4 * scale, 1e-4 * scale}};
  return d;
}

std::string printed(const Diagnosis& diagnosis) {
  std::ostringstream out;
  print_diagnosis(diagnosis, Paint(false), out);
  return out.str();
}

TEST(PrintedUnits, OfADiagnosisAreThoseOfItsPage) {
  const std::string text = printed(damped(1.0));
  for (const char* part :
       {"\nwhere         around (-3, 13, 41) mm: 5.3 sigma rms there\n",
        "\nerror         0.305 mm rms: noise 0.100, beyond noise 0.288, of the mesh 0.0210\n",
        "\nmissing force up to 30 N/kg, around (-15, 1, 38) mm along (0.67, -0.02, 0.74)\n",
        "\ncandidate                 explains   held-out [mm]   probability         z\n",
        "\nviscous_damping              91.0 %           0.102         95.0 %       1.2\n",
        "\ngravity                       0.0 %               -          0.0 %         -\n",
        "\nmodel                     held-out [mm]   fitted [mm]   noise [mm]\n",
        "\nas given                          0.349         0.281        0.100\n  elasticity.young_modulus = 21.47 kPa\n",
        "\n+ viscous_damping                 0.102         0.105        0.100\n  elasticity.young_modulus = 1.186 MPa\n"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
}

TEST(PrintedUnits, OfASmallBodyAreSmall) {
  const std::string text = printed(damped(1e-2));
  for (const char* part : {"\nerror         3.05 µm rms: noise 1.00, beyond noise 2.88, of the mesh 0.210\n",
                           "\ncandidate                 explains   held-out [µm]   probability         z\n",
                           "\nviscous_damping              91.0 %            1.02         95.0 %       1.2\n",
                           "\nmodel                     held-out [µm]   fitted [µm]   noise [µm]\n",
                           "\nas given                           3.49          2.81         1.00\n"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
}

TEST(PrintedUnits, LeaveTheNumbersOfTheFileInMetres) {
  const std::string json = diagnosis_json(damped(1.0));
  EXPECT_NE(json.find("around (-3, 13, 41) mm"), std::string::npos) << json;
  EXPECT_NE(json.find("0.000349"), std::string::npos) << json;
}

// Two recordings with an error in metres, and a sensor that each has turned by itself.
std::string summary(double error) {
  EstimationRun run;
  RecordingRecord first;
  first.name = "first.bag";
  first.rms_error = error;
  first.own = {{"sensor_rotation.angle", "rad", -0.0042, 0.0005, -0.0052, -0.0032}};
  RecordingRecord second = first;
  second.name = "second.bag";
  second.rms_error = 0.1 * error;
  second.own.clear();
  run.results.recordings = {first, second};
  run.results.rms_error = error;
  run.results.noise_rms = error;
  std::ostringstream out;
  print_summary(run, Paint(false), out);
  return out.str();
}

TEST(PrintedUnits, OfAnEstimateAreThoseOfItsPage) {
  std::string text = summary(3.974e-4);
  for (const char* part : {"\nrms error     0.3974 mm, 1 of the noise;", " error [mm]  of noise", " 0.397 ", " 0.0397 ",
                           "  sensor_rotation.angle          -4.200 -+ 0.98 mrad\n"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
  text = summary(3.974e-6);
  for (const char* part : {"\nrms error     3.974 µm, 1 of the noise;", " error [µm]  of noise", " 3.97 ", " 0.397 "})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
}

TEST(PrintedUnits, OfAMapArePlacesInMillimetres) {
  EstimationRun run;
  run.results.frames.resize(1);
  run.results.map.emplace();
  StiffnessPatch patch;
  patch.center = {0.012, -0.0003, 0.1};
  patch.young_modulus = 12e3;
  patch.std = 0.1;
  patch.lower95 = 10e3;
  patch.upper95 = 14.4e3;
  patch.identified = true;
  run.results.map->patches = {patch};
  run.seconds = 1.0;
  std::ostringstream out;
  print_summary(run, Paint(false), out);
  EXPECT_NE(out.str().find("\n  at (12, 0, 100) mm        12.0 kPa, 95 %: 10.0 .. 14.4\n"), std::string::npos) << out.str();
}

TEST(PrintedUnits, AreAlignedByCharacters) {
  EXPECT_EQ(right_aligned("µm", 4), "  µm");
  EXPECT_EQ(right_aligned("mm", 4), "  mm");
  EXPECT_EQ(right_aligned("longer", 4), "longer");
}

}  // namespace
}  // namespace tissue_stiffness
