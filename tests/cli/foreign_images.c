// A module of images as another version of the tool may have it: of the same names, with another identity and layout.
extern const unsigned long long probebenchImageCodecs[1];
const unsigned long long probebenchImageCodecs[1] = {1};
