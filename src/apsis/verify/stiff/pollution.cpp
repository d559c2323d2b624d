#include <apsis/verify/stiff_problem.hpp>

namespace apsis {
namespace pollution_problem {
namespace {

/// Twenty species and 25 reactions of the air.
struct formula {
  template <class T, class U, class V>
  void operator()(const T&, const U& y, V& f) const {
    const auto r1 = 0.35 * y[0], r2 = 26.6 * y[1] * y[3], r3 = 1.23e4 * y[4] * y[1], r4 = 8.6e-4 * y[6],
               r5 = 8.2e-4 * y[6], r6 = 1.5e4 * y[6] * y[5], r7 = 1.3e-4 * y[8], r8 = 2.4e4 * y[8] * y[5],
               r9 = 1.65e4 * y[10] * y[1], r10 = 9e3 * y[10] * y[0], r11 = 0.022 * y[12],
               r12 = 1.2e4 * y[9] * y[1], r13 = 1.88 * y[13], r14 = 1.63e4 * y[0] * y[5], r15 = 4.8e6 * y[2],
               r16 = 3.5e-4 * y[3], r17 = 0.0175 * y[3], r18 = 1e8 * y[15], r19 = 4.44e11 * y[15],
               r20 = 1240.0 * y[16] * y[5], r21 = 2.1 * y[18], r22 = 5.78 * y[18], r23 = 0.0474 * y[0] * y[3],
               r24 = 1780.0 * y[18] * y[0], r25 = 3.12 * y[19];
    f[0] = -r1 - r10 - r14 - r23 - r24 + r2 + r3 + r9 + r11 + r12 + r22 + r25;
    f[1] = -r2 - r3 - r9 - r12 + r1 + r21;
    f[2] = -r15 + r1 + r17 + r19 + r22;
    f[3] = -r2 - r16 - r17 - r23 + r15;
    f[4] = -r3 + 2.0 * r4 + r6 + r7 + r13 + r20;
    f[5] = -r6 - r8 - r14 - r20 + r3 + 2.0 * r18;
    f[6] = -r4 - r5 - r6 + r13;
    f[7] = r4 + r5 + r6 + r7;
    f[8] = -r7 - r8;
    f[9] = -r12 + r7 + r9;
    f[10] = -r9 - r10 + r8 + r11;
    f[11] = r9;
    f[12] = -r11 + r10;
    f[13] = -r13 + r12;
    f[14] = r14;
    f[15] = -r18 - r19 + r16;
    f[16] = -r20;
    f[17] = r20;
    f[18] = -r21 - r22 - r24 + r23 + r25;
    f[19] = -r25 + r24;
  }
};

std::vector<double> start() {
  std::vector<double> y(20, 0.0);
  y[1] = 0.2;
  y[3] = 0.04;
  y[6] = 0.1;
  y[7] = 0.3;
  y[8] = 0.01;
  y[16] = 0.007;
  return y;
}

}  // namespace
}  // namespace pollution_problem

extern const stiff_problem_entry stiff_problem_pollution;
const stiff_problem_entry stiff_problem_pollution = {
    .name = "pollution",
    .description = "chemistry of the air, twenty species with rates up to 4.4e11",
    .source = "Verwer (1994)",
    .origin = "Mazzia & Magherini, Test Set for IVP Solvers 2.4 (2008), POLLU",
    .times = {0, 60},
    .sizes = {1e-4},
    .start = pollution_problem::start,
    .rate = [](std::size_t) { return make_stiff_rate(pollution_problem::formula{}); },
    .reference = {{0, 0.5646255480022769e-1},   {1, 0.1342484130422339},     {2, 0.4139734331099427e-8},
                  {3, 0.5523140207484359e-2},   {4, 0.2018977262302196e-6},  {5, 0.1464541863493966e-6},
                  {6, 0.7784249118997964e-1},   {7, 0.3245075353396018},     {8, 0.7494013383880406e-2},
                  {9, 0.1622293157301561e-7},   {10, 0.1135863833257075e-7}, {11, 0.2230505975721359e-2},
                  {12, 0.2087162882798630e-3},  {13, 0.1396921016840158e-4}, {14, 0.8964884856898295e-2},
                  {15, 0.4352846369330103e-17}, {16, 0.6899219696263405e-2}, {17, 0.1007803037365946e-3},
                  {18, 0.1772146513969984e-5},  {19, 0.5682943292316392e-4}}};

}  // namespace apsis
