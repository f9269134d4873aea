import "corniche-map";
