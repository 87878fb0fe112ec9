#include "picture.hpp"

#include <cstdlib>

namespace ccx {

void draw_plastic_strain(const fs::path& directory, const Mesh& quarter, const std::vector<Numbers>& values) {
    // A node on the free surface takes the values of the integration points next to it.
    const int along = quarter.cells[0], away = quarter.cells[1];
    std::vector<double> sum(static_cast<std::size_t>((along + 1) * (away + 1))), count(sum.size());
    for (const Numbers& row : values) {
        const int element = static_cast<int>(row[0]) - 1, point = static_cast<int>(row[1]) - 1;
        if (point / 4 != 1) continue;  // the layer at the surface
        const int i = element % along + point % 2, j = element / along % away + point / 2 % 2;
        const auto node = static_cast<std::size_t>(i + (along + 1) * j);
        sum[node] += row[2];
        count[node] += 1.0;
    }
    std::string text = "# x, y, plastic strain of a quarter of the plate\n";
    for (int j = 0; j <= away; ++j) {
        for (int i = 0; i <= along; ++i) {
            const Position& x = quarter.position(quarter.node(2 * i, 2 * j, 2));
            const auto node = static_cast<std::size_t>(i + (along + 1) * j);
            text += number(x[0]) + " " + number(x[1]) + " " + number(sum[node] / count[node]) + "\n";
        }
        text += "\n";
    }
    write_text(directory / "plastic_strain.dat", text);
    write_text(directory / "plastic_strain.gp",
               "set terminal svg size 520,640 background 'white'\n"
               "set output 'plastic_strain.svg'\n"
               "set title 'Equivalent plastic strain'\n"
               "set view map\nset size ratio -1\nunset key\nset border 0\nunset xtics\nunset ytics\n"
               "set pm3d interpolate 3,3\n"
               "set palette defined (0 '#f4f1ea', 0.15 '#f7d88c', 0.45 '#ee7f3b', 0.75 '#b3263c', 1 '#3b0f4d')\n"
               "set cbrange [0:*]\nset format cb '%.3f'\n"
               "splot 'plastic_strain.dat' using 1:2:3 with pm3d, '' using (-$1):2:3 with pm3d, \\\n"
               "      '' using 1:(-$2):3 with pm3d, '' using (-$1):(-$2):3 with pm3d\n");
    const std::string command = "cd '" + directory.string() + "' && gnuplot plastic_strain.gp 2>gnuplot.log";
    if (std::system(command.c_str()) != 0) std::fprintf(stderr, "no picture: gnuplot is missing or failed\n");
}

}  // namespace ccx
