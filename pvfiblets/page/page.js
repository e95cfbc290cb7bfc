// Built by `make client` of sources 5594dc479a882062
"use strict";(()=>{var ze=Object.defineProperty;var Ne=(o,e,t)=>e in o?ze(o,e,{enumerable:!0,configurable:!0,writable:!0,value:t}):o[e]=t;var c=(o,e,t)=>Ne(o,typeof e!="symbol"?e+"":e,t);var z={blocks:{ClipPlanes:{bytes:400,fields:{clip_brushes:256,clip_plane_count:384,clip_planes:0,clip_rounding:388,clip_tilts:128}},Coding:{bytes:96,fields:{anchor_scale:0,end_vector_scale:28,lattice_edge:24,radius_scale:12,rotation_scales:32,step_low:16,step_span:20}},Frame:{bytes:208,fields:{half_line_width:172,line_reach:184,most_pixels_per_mm:192,plane_rounding:188,reference:160,segment_deviation:200,segment_size:204,view_planes:64,viewport:176,w_per_mm:196,window_from_local:0}},Rotations:{bytes:16384,fields:{rotations:0}}},fields:{anchor_x:[0,0,16],anchor_y:[0,16,16],anchor_z:[1,0,16],begin:[1,30,1],cap:[2,26,4],code:[1,0,22],end:[1,31,1],kind:[2,30,2],last:[2,20,6],point:[2,0,20],rank:[1,16,14],shape:[0,0,32],step:[1,22,10]},page_bits:14,rotation_scales:[39380907423947065e-23,5413425014921813e-22,7445069627465273e-22,1023472805172787e-21,14070004681343562e-22,19338988295203308e-22,2657444838405354e-21,3649580548881204e-21,5006992068956606e-21,6855771061964333e-21,9352394044981338e-21,1266809158551041e-20,1692779733275529e-20,22030990294297226e-21,27206533559365198e-21,300810752378311e-19],rotations:"AAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqcs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbRuK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqgs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6nLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420biuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqcs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqgs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07SvlgAAAABR/0H/2gEqAOX9nQGYAKT8OgKAA037vf7xBG/92v3hBVr9l/nkBjkDHPh5AnkESPgOAlkJpvch+sIKm/6b+MYIgP/p8/kIBQmt8mL/tgoQ9w/+bg5X943zYg92A83xIwgnBdjvXAfvD0Tv//ifEan5BPcYEe76xOw4ERILQuuRAz0N6O7VAR4WSu+L8FUXHQBN7g8QQgKk5yEP7xPU5mz7IRYT8vH4wBmO88DnFBqrCbvlsgpiDN/lrggoHBzm0/DgHZb5/e1bGRb8meCDGN0US98xAbIXpuhG/sMhIOqG5Ywi0gTV4hYUEAj33PwRvh/L3JT0KCJr8CHxDSMd853bjCJfEpvZ7AnlFU/eswYmKIffmeagKcL8JePkHmsANtXxHDggYdS++3UjXeXB9xosBeh52TQsWQyb1v0UhxAV1KwRBizF1EHrYS7z8QnnISrZ9ZPPnSgmHdzNAAZAIVLZoAF8M6vbxtpxNPAC9daUIagHBcttHqgs6cqD8wUwGuWb7r80/ujmzPEzVhYkysgSRBtUzT8OQzgTz93fRjqS9hjbtS6h+yLEBiyIKf7CG//1LR/XrfmuPbXa2s3cPeEL8slJIYIRecLfHKM5UsPU6Nk86+cv4007De1XwGQ5ZCL5vYIN2ScMycsH7EMBzNzSUUUm/srNhjBGBNK5jywDN4G5dvWAO+LXHe8+RsXcYMBpRUUXqbztHaIdAbw8GJxGA74U3GNJze3q1WQ/I/RbtDg8EDCnskUFzTWGx3j+d07Qy8DE+k59CKa/Xy+LDyKxDyoPReKxW+lSSbjbReK5TOzh57KuSr0kqa99F54rAriPEANTVruzzRRVqfZEx7ZAHf5+qSc82j64qEH6m0T8yIHyX1eszhK2xFZOFTixICsdHYuqciQbU4+sJ9vcVqnijNO3UCXqAaZLTdwzhKMLDgA70Lb2BUlelbsvvl9fVALBtwM/wgpGoAA5Ok6toLvstFOUzTXkKl6v1GGnO1xBJBKjvCOXLHemuhuVYOypRcuKY6bsZ8PgUVT1PJr0TCJExpjAAURLq7in+OZn9L4RrsNnjBDupyQ6xxkymacynl37mgndh2Jd1ffTaWLa3UKZ+l7qNMiVPxmGPUKl/w/rbEiqNLrObon5WLLxT0YDJZBwSQhV9o/a8t1bv73t6FlvksXsncVt+yBgmAYyySqylBgpcmwLmJfLfnBN4DrCv2MX6kiMr17LRuqJzQtnTzOncQGQd96tfKggeBYJ76C5SrITPoieQvxljomw4TVsIsYn1y90d89TjvtwODOribEmVz0nk2YcIXoymOC4B31D7oKv4WE3+QOBGlteWQSAofuqYXusWfD/f9O0r5YAAAAAUf9B/9oBKgDl/Z0BmACk/DoCgANN+73+8QRv/dr94QVa/Zf55AY5Axz4eQJ5BEj4DgJZCab3IfrCCpv+m/jGCID/6fP5CAUJrfJi/7YKEPcP/m4OV/eN82IPdgPN8SMIJwXY71wH7w9E7//4nxGp+QT3GBHu+sTsOBESC0LrkQM9Deju1QEeFkrvi/BVFx0ATe4PEEICpOchD+8T1OZs+yEWE/Lx+MAZjvPA5xQaqwm75bIKYgzf5a4IKBwc5tPw4B2W+f3tWxkW/JnggxjdFEvfMQGyF6boRv7DISDqhuWMItIE1eIWFBAI99z8Eb4fy9yU9Cgia/Ah8Q0jHfOd24wiXxKb2ewJ5RVP3rMGJiiH35nmoCnC/CXj5B5rADbV8Rw4IGHUvvt1I13lwfcaLAXoedk0LFkMm9b9FIcQFdSsEQYsxdRB62Eu8/EJ5yEq2fWTz50oJh3czQAGQCFS2aABfDOr28bacTTwAvXWlCGoBwXLbR6oLOnKg/MFMBrlm+6/NP7o5szxM1YWJMrIEkQbVM0/DkM4E8/d30Y6kvYY27UuofsixAYsiCn+whv/9S0f1635rj212trN3D3hC/LJSSGCEXnC3xyjOVLD1OjZPOvnL+NNOw3tV8BkOWQi+b2CDdknDMnLB+xDAczc0lFFJv7KzYYwRgTSuY8sAzeBuXb1gDvi1x3vPkbF3GDAaUVFF6m87R2iHQG8PBicRgO+FNxjSc3t6tVkPyP0W7Q4PBAwp7JFBc01hsd4/ndO0MvAxPpOfQimv18viw8isQ8qD0XisVvpUkm420XiuUzs4eeyrkq9JKmvfReeKwK4jxADU1a7s80UVan2RMe2QB3+fqknPNo+uKhB+ptE/MiB8l9XrM4StsRWThU4sSArHR2LqnIkG1OPrCfb3Fap4ozTt1Al6gGmS03cM4SjCw4AO9C29gVJXpW7L75fX1QCwbcDP8IKRqAAOTpOraC77LRTlM015Cper9RhpztcQSQSo7wjlyx3problWDsqUXLimOm7GfD4FFU9Tya9EwiRMaYwAFES6u4p/jmZ/S+Ea7DZ4wQ7qckOscZMpmnMp5d+5oJ3YdiXdX302li2t1Cmfpe6jTIlT8Zhj1Cpf8P62xIqjS6zm6J+Viy8U9GAyWQcEkIVfaP2vLdW7+97ehZb5LF7J3FbfsgYJgGMskqspQYKXJsC5iXy35wTeA6wr9jF+pIjK9ey0bqic0LZ08zp3EBkHferXyoIHgWCe+guUqyEz6InkL8ZY6JsOE1bCLGJ9cvdHfPU477cDgzq4mxJlc9J5NmHCF6MpjguAd9Q+6Cr+FhN/kDgRpbXlkEgKH7qmF7rFnw/3/TtK+WAAAAAFH/Qf/aASoA5f2dAZgApPw6AoADTfu9/vEEb/3a/eEFWv2X+eQGOQMc+HkCeQRI+A4CWQmm9yH6wgqb/pv4xgiA/+nz+QgFCa3yYv+2ChD3D/5uDlf3jfNiD3YDzfEjCCcF2O9cB+8PRO//+J8RqfkE9xgR7vrE7DgREgtC65EDPQ3o7tUBHhZK74vwVRcdAE3uDxBCAqTnIQ/vE9TmbPshFhPy8fjAGY7zwOcUGqsJu+WyCmIM3+WuCCgcHObT8OAdlvn97VsZFvyZ4IMY3RRL3zEBshem6Eb+wyEg6obljCLSBNXiFhQQCPfc/BG+H8vclPQoImvwIfENIx3znduMIl8Sm9nsCeUVT96zBiYoh9+Z5qApwvwl4+QeawA21fEcOCBh1L77dSNd5cH3GiwF6HnZNCxZDJvW/RSHEBXUrBEGLMXUQethLvPxCechKtn1k8+dKCYd3M0ABkAhUtmgAXwzq9vG2nE08AL11pQhqAcFy20eqCzpyoPzBTAa5ZvuvzT+6ObM8TNWFiTKyBJEG1TNPw5DOBPP3d9GOpL2GNu1LqH7IsQGLIgp/sIb//UtH9et+a49tdrazdw94QvyyUkhghF5wt8cozlSw9To2Tzr5y/jTTsN7VfAZDlkIvm9gg3ZJwzJywfsQwHM3NJRRSb+ys2GMEYE0rmPLAM3gbl29YA74tcd7z5GxdxgwGlFRRepvO0doh0BvDwYnEYDvhTcY0nN7erVZD8j9Fu0ODwQMKeyRQXNNYbHeP53TtDLwMT6Tn0Ipr9fL4sPIrEPKg9F4rFb6VJJuNtF4rlM7OHnsq5KvSSpr30XnisCuI8QA1NWu7PNFFWp9kTHtkAd/n6pJzzaPrioQfqbRPzIgfJfV6zOErbEVk4VOLEgKx0di6pyJBtTj6wn29xWqeKM07dQJeoBpktN3DOEowsOADvQtvYFSV6Vuy++X19UAsG3Az/CCkagADk6Tq2gu+y0U5TNNeQqXq/UYac7XEEkEqO8I5csd6a6G5Vg7KlFy4pjpuxnw+BRVPU8mvRMIkTGmMABREuruKf45mf0vhGuw2eMEO6nJDrHGTKZpzKeXfuaCd2HYl3V99NpYtrdQpn6Xuo0yJU/GYY9QqX/D+tsSKo0us5uiflYsvFPRgMlkHBJCFX2j9ry3Vu/ve3oWW+SxeydxW37IGCYBjLJKrKUGClybAuYl8t+cE3gOsK/YxfqSIyvXstG6onNC2dPM6dxAZB33q18qCB4FgnvoLlKshM+iJ5C/GWOibDhNWwixifXL3R3z1OO+3A4M6uJsSZXPSeTZhwhejKY4LgHfUPugq/hYTf5A4EaW15ZBICh+6phe6xZ8P9/07Svlg==",shaders:{"effects/picture/antialias_coverage.frag":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
const float EDGE_STEPS=448.0;
const float EDGE_LEAST=2.0;
const float WIDTH_STEPS=32.0;
uint packed_edges(vec2 n,float e,float w,uint end){
vec2 q=n/max(abs(n.x)+ abs(n.y),1e-30);
int turn=int((q.y>=0.0?1.0 - q.x:3.0 + q.x)*512.0 + 0.5)&2047;
int inside=int(clamp((e + EDGE_LEAST)*EDGE_STEPS + 0.5,0.0,2047.0));
int across=int(clamp(w*WIDTH_STEPS + 0.5,1.0,127.0));
return uint(turn|(inside<<11)|(across<<22))|(end<<29u);
}
struct Edges{
vec2 n;
float e;
float w;
uint end;
float stop;
};
Edges unpacked_edges(uint word){
float turn=float(int(word&2047u))/512.0,x=abs(turn - 2.0)- 1.0;
int width=int((word>>22u)&127u),end=int(word>>29u);
return Edges(normalize(vec2(x,turn<2.0?1.0 - abs(x):abs(x)- 1.0)),
float(int((word>>11u)&2047u))/EDGE_STEPS - EDGE_LEAST,width==127?128.0:float(width)/WIDTH_STEPS,
uint(end),float(end>3?end - 5:end - 2)/3.0);
}
uniform usampler2D shown;
uniform ivec2 shift;
out vec4 colour;
const vec4 X0=vec4(1.5,2.5,5.5,6.5),X1=vec4(-2.5,-1.5,-5.5,-7.5);
const vec4 Y0=vec4(1.5,5.5,3.5,7.5),Y1=vec4(2.5,6.5,4.5,0.5);
const vec4 X2=vec4(4.5,3.5,0.5,7.5),X3=vec4(-0.5,-4.5,-3.5,-6.5);
const vec4 Y2=vec4(-0.5,-4.5,-6.5,-3.5),Y3=vec4(-2.5,-1.5,-5.5,-7.5);
const uint EVERY=0x01010101u,SAMPLE=12u,PIXEL=16u*SAMPLE;
const int OWN=4;
struct Band{
vec2 n;
float away;
float size;
};
uint bits(bvec4 inside){
return(inside.x?1u:0u)|(inside.y?0x100u:0u)|(inside.z?0x10000u:0u)|(inside.w?0x1000000u:0u);
}
uint count(uint samples){return(samples*EVERY)>>24u;}
Band band_of(Edges edges,vec2 at,bool there){
float along=edges.n.x*at.y - edges.n.y*at.x;
bool beyond=edges.end==7u||edges.end!=0u&&(edges.end<4u)==(along>edges.stop);
return Band(edges.n/16.0,dot(edges.n,at)- edges.e + 0.5*edges.w,there&&!beyond?0.5*edges.w:-1.0);
}
uint covered(Band band,vec4 x,vec4 y){
return bits(lessThanEqual(abs(band.n.x*x + band.n.y*y + band.away),vec4(band.size)));
}
uint within(Edges edges,vec4 x,vec4 y){
vec4 along=(edges.n.x*y - edges.n.y*x)/16.0;
vec2 range=edges.end==7u?vec2(-0.5,0.5)
:vec2(edges.end<4u?-1.0:edges.stop,edges.end>0u&&edges.end<4u?edges.stop:1.0);
return bits(lessThanEqual(abs(along - 0.5*(range.x + range.y)),vec4(0.5*(range.y - range.x))));
}
uvec4 around[9];
Band bands[9];
uint visible[9];
uint shares[9];
uint behind[9];
uint lines[9];
#define NINE(what) what(0, -1, -1) what(1, 0, -1) what(2, 1, -1) what(3, -1, 0) what(4, 0, 0) what(5, 1, 0) what(6, -1, 1) what(7, 0, 1) what(8, 1, 1)
#define EIGHT(what) what(0, -1, -1) what(1, 0, -1) what(2, 1, -1) what(3, -1, 0) what(5, 1, 0) what(6, -1, 1) what(7, 0, 1) what(8, 1, 1)
#define FETCH(k, right, up) around[k] = texelFetch(shown, pixel + ivec2(right, up), 0);
#define BEGIN(k, right, up) bands[k] = band_of(unpacked_edges(around[k].y), -vec2(right, up), around[k].y != 0u && (line || around[k].x < around[OWN].x)); behind[k] = line && around[k].y == 0u && around[k].x > around[OWN].x ? 1u : 0u; lines[k] = line && around[k].y != 0u ? 1u : 0u; visible[k] = shares[k] = 0u;
#define QUARTER(right, up, a, b, c) { uint m = covered(bands[OWN], right, up) & within(own, right, up), ma = covered(bands[a], right, up), mb = covered(bands[b], right, up), mc = covered(bands[c], right, up), open = EVERY & ~((m | ma) | (mb | mc)), left = count(open); bool a_first = around[a].x < depth, b_first = around[b].x < depth, c_first = around[c].x < depth, ab = around[a].x <= around[b].x, ac = around[a].x <= around[c].x, bc = around[b].x <= around[c].x; visible[OWN] += m & ~((a_first ? ma : 0u) | (b_first ? mb : 0u) | (c_first ? mc : 0u)); visible[a] += ma & ~((a_first ? 0u : m) | (ab ? 0u : mb) | (ac ? 0u : mc)); visible[b] += mb & ~((b_first ? 0u : m) | (ab ? ma : 0u) | (bc ? 0u : mc)); visible[c] += mc & ~((c_first ? 0u : m) | (ac ? ma : 0u) | (bc ? mb : 0u)); uint backs = behind[a] + behind[b] + behind[c], fronts = lines[a] + lines[b] + lines[c], n = backs > 0u ? backs : fronts; left *= n == 3u ? SAMPLE / 3u : n == 2u ? SAMPLE / 2u : SAMPLE; shares[a] += left * (backs > 0u ? behind[a] : lines[a]); shares[b] += left * (backs > 0u ? behind[b] : lines[b]); shares[c] += left * (backs > 0u ? behind[c] : lines[c]); shares[OWN] += n == 0u ? left : 0u; }
#define ADOPT(k) if (abs(bands[k].away) <= bands[k].size && around[k].x < depth) { depth = around[k].x; bands[OWN] = bands[k]; of_own = around[k].z; }
#define SHARE(k, right, up) shares[k] += SAMPLE * count(visible[k]);
#define ADD(k, right, up) red_blue += shares[k] * (around[k].z & 0xFF00FFu); green_alpha += shares[k] * ((around[k].z >> 8u) & 0xFF00FFu);
void main(){
ivec2 pixel=ivec2(gl_FragCoord.xy)+ shift;
NINE(FETCH)
if(((around[0].y|around[1].y|around[2].y)|(around[3].y|around[4].y|around[5].y)
|(around[6].y|around[7].y|around[8].y))==0u)discard;
Edges own=unpacked_edges(around[OWN].y);
bool line=around[OWN].y!=0u;
EIGHT(BEGIN)
bands[OWN]=Band(own.n/16.0,0.5*own.w - own.e,line?0.5*own.w:-1.0);
visible[OWN]=shares[OWN]=0u;
uint depth=around[OWN].x,of_own=around[OWN].z;
if(!line){ADOPT(1)ADOPT(3)ADOPT(5)ADOPT(7)}
QUARTER(X0,Y0,5,7,8)
QUARTER(X1,Y1,3,7,6)
QUARTER(X2,Y2,5,1,2)
QUARTER(X3,Y3,3,1,0)
EIGHT(SHARE)
uint mine=SAMPLE*count(visible[OWN]);
if(shares[OWN] +(line?mine:0u)==PIXEL)discard;
uint red_blue=mine*(of_own&0xFF00FFu),green_alpha=mine*((of_own>>8u)&0xFF00FFu);
NINE(ADD)
colour=vec4(red_blue&0xFFFFu,green_alpha&0xFFFFu,red_blue>>16u,green_alpha>>16u)/(255.0*float(PIXEL));
}
`,"page/background.frag":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
uniform vec3 bottom;
uniform vec3 top;
uniform float height;
layout(location=0)out vec4 colour;
void main(){colour=vec4(mix(bottom,top,gl_FragCoord.y/height),1.0);}
`,"page/copy.frag":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
uniform highp sampler2D drawn;
layout(location=0)out vec4 colour;
void main(){colour=vec4(texelFetch(drawn,ivec2(gl_FragCoord.xy),0).rgb,1.0);}
`,"page/decode.vert":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define FEATURE_ANCHORS_LOW 1
#define FEATURE_DIRECTION 1
#define FEATURE_LATTICE 1
#define FEATURE_POINT_MASK 0
#define FEATURE_RANK_TO_ID 0
#define FEATURE_TUBES 0
#define FEATURE_WIDE_LATTICE 1
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
const uint FIBLET_MAX_POINTS=60u;
const uint FIBLET_PAGE_BITS=14u;
const uint FIBLET_CAPS=16u;
const float FIBLET_DIRECTION_SCALE=32767.0;
const float FIBLET_STEP_LEVELS=1023.0;
const uint FIBLET_WIDE_HEADER=20u;
const uint FIBLET_PLAIN_BYTES=12u;
const uint FIBLET_ANCHORS_WORDS=2u;
const uint FIBLET_DECODING_WORDS=3u;
const uint KIND_DIRECTION=0u;
const uint KIND_LATTICE8=1u;
const uint KIND_LATTICE16=2u;
const uint KIND_WIDE=3u;
uint fiblet_anchor_x(uvec2 words){return bitfieldExtract(words.x,0,16);}
uint fiblet_anchor_y(uvec2 words){return bitfieldExtract(words.x,16,16);}
uint fiblet_anchor_z(uvec2 words){return bitfieldExtract(words.y,0,16);}
uint fiblet_rank(uvec2 words){return bitfieldExtract(words.y,16,14);}
uint fiblet_begin(uvec2 words){return bitfieldExtract(words.y,30,1);}
uint fiblet_end(uvec2 words){return bitfieldExtract(words.y,31,1);}
uint fiblet_shape(uvec3 words){return bitfieldExtract(words.x,0,32);}
uint fiblet_code(uvec3 words){return bitfieldExtract(words.y,0,22);}
uint fiblet_step(uvec3 words){return bitfieldExtract(words.y,22,10);}
uint fiblet_point(uvec3 words){return bitfieldExtract(words.z,0,20);}
uint fiblet_last(uvec3 words){return bitfieldExtract(words.z,20,6);}
uint fiblet_cap(uvec3 words){return bitfieldExtract(words.z,26,4);}
uint fiblet_kind(uvec3 words){return bitfieldExtract(words.z,30,2);}
ivec3 fiblet_end_vector(uint word){return ivec3(bitfieldExtract(int(word),0,10),bitfieldExtract(int(word),10,10),bitfieldExtract(int(word),20,10));}
layout(std140)uniform Frame{
mat4 window_from_local;
vec4 view_planes[6];
uvec3 reference;
float half_line_width;
vec2 viewport;
float line_reach;
float plane_rounding;
float most_pixels_per_mm;
float w_per_mm;
float segment_deviation;
float segment_size;
};
#if FEATURE_TUBES
#endif
layout(std140)uniform Coding{
vec3 anchor_scale;
float radius_scale;
float step_low;
float step_span;
float lattice_edge;
float end_vector_scale;
vec4 rotation_scales[4];
};
layout(std140)uniform Rotations{
uvec4 rotations[1024];
};
const int ROW_BITS=12;
const uint chunk_first_rank=0u,chunk_pages=0u;
uniform highp usampler2D anchor_texels;
uniform highp usampler2D page_texels;
uniform highp usampler2D decoding_texels;
uniform highp usampler2D code_texels;
uniform uint chunk_fiblets;
ivec2 texel(uint index){return ivec2(int(index&((1u<<uint(ROW_BITS))- 1u)),int(index>>uint(ROW_BITS)));}
uvec2 anchor_words(uint f){return texelFetch(anchor_texels,texel(f),0).xy;}
uvec4 page_words(uint row){return texelFetch(page_texels,texel(row),0);}
uint decoding_word(uint index){return texelFetch(decoding_texels,texel(index),0).x;}
uint code_word(uint index){return texelFetch(code_texels,texel(index),0).x;}
uint rotation_word(uint index){return rotations[index>>2][index&3u];}
uint bound_word(uint index){return 0u;}
const uint chunk_end_words=0u;
#if FEATURE_ANCHORS_LOW
uniform highp usampler2D anchor_low_texels;
uint anchor_low_word(uint index){return texelFetch(anchor_low_texels,texel(index),0).x;}
#endif
#if FEATURE_RANK_TO_ID
uint id_of_rank(uint rank){
uint index=rank - chunk_first_rank;
return page_words(chunk_pages +(index>>2))[index&3u];
}
#endif
#if FEATURE_ANCHORS_LOW
uint anchor_low(uint index){return bitfieldExtract(anchor_low_word(index>>1),int(index&1u)*16,16);}
#endif
float difference(uint a,uint b){return a>=b?float(a - b):-float(b - a);}
vec3 anchor_local(uint f){
uvec2 words=anchor_words(f);
uvec3 q=uvec3(fiblet_anchor_x(words),fiblet_anchor_y(words),fiblet_anchor_z(words));
#if FEATURE_ANCHORS_LOW
q=(q<<16u)|uvec3(anchor_low(3u*f),anchor_low(3u*f + 1u),anchor_low(3u*f + 2u));
vec3 d=vec3(difference(q.x,reference.x),difference(q.y,reference.y),difference(q.z,reference.z));
#else
vec3 d=vec3(ivec3(q)- ivec3(reference));
#endif
precise vec3 p=d*anchor_scale;
return p;
}
bool begins(uint f){return fiblet_begin(anchor_words(f))!=0u;}
bool ends(uint f){return fiblet_end(anchor_words(f))!=0u;}
uint rank_of(uint f){return page_words(f>>FIBLET_PAGE_BITS).x + fiblet_rank(anchor_words(f));}
uvec3 decoding_words(uint f){
uint at=FIBLET_DECODING_WORDS*f;
return uvec3(decoding_word(at),decoding_word(at + 1u),decoding_word(at + 2u));
}
uint first_code(uint f,uvec3 words){return page_words(f>>FIBLET_PAGE_BITS).y + fiblet_code(words);}
uint code_at(uint byte){return bitfieldExtract(code_word(byte>>2),int(byte&3u)*8,8);}
uint codes_at(uint byte){
uint word=byte>>2,shift=(byte&3u)*8u;
uint low=code_word(word);
return shift==0u?low:(low>>shift)|(code_word(word + 1u)<<(32u - shift));
}
float rotation_scale(uint cap){return rotation_scales[cap>>2][cap&3u];}
vec4 rotation(uint cap,uint code,float scale){
int word=int(rotation_word((cap<<8u)+ code));
precise vec2 t=scale*vec2(bitfieldExtract(word,0,16),bitfieldExtract(word,16,16));
precise float w=sqrt(1.0 - t.x*t.x - t.y*t.y);
return vec4(0.0,t,w);
}
float sign_of(int value){return value<0?-1.0:1.0;}
float step_length(uvec3 words){return step_low + float(fiblet_step(words))*(step_span/FIBLET_STEP_LEVELS);}
vec4 first_frame(uint shape){
int u=bitfieldExtract(int(shape),0,16),v=bitfieldExtract(int(shape),16,16);
bool forward=abs(u)+ abs(v)<=int(FIBLET_DIRECTION_SCALE);
precise vec2 s=vec2(float(u),float(v))/FIBLET_DIRECTION_SCALE;
precise float x=1.0 - abs(s.x)- abs(s.y);
precise vec3 d=forward?vec3(x,s)
:vec3(x,(1.0 - abs(s.y))*sign_of(u),(1.0 - abs(s.x))*sign_of(v));
d=d/sqrt(dot(d,d));
precise vec3 h=forward?vec3(1.0 + d.x,-d.z,d.y):vec3(1.0 - d.x,d.z,-d.y);
h=h/sqrt(dot(h,h));
return forward?vec4(0.0,h.y,h.z,h.x):vec4(h.y,0.0,h.x,-h.z);
}
vec3 rotated_x(vec4 q){
precise vec3 d=vec3(1.0 - 2.0*(q.y*q.y + q.z*q.z),2.0*(q.x*q.y + q.w*q.z),2.0*(q.x*q.z - q.w*q.y));
return d;
}
vec4 turned(vec4 a,vec4 t){
precise vec4 q=vec4(a.x*t.w + a.y*t.z - a.z*t.y,a.w*t.y - a.x*t.z + a.y*t.w,
a.w*t.z + a.x*t.y + a.z*t.w,a.w*t.w - a.y*t.y - a.z*t.z);
return q;
}
#if FEATURE_LATTICE
void lattice_box(uvec3 words,inout uint byte,out ivec3 lo,out uvec2 n,out uint width){
int shape=int(fiblet_shape(words));
lo=ivec3(bitfieldExtract(shape,0,8),bitfieldExtract(shape,8,8),bitfieldExtract(shape,16,8));
n=uvec2((uint(shape)>>24u)+ 1u,(fiblet_step(words)&255u)+ 1u);
width=fiblet_kind(words);
#if FEATURE_WIDE_LATTICE
if(fiblet_kind(words)==KIND_WIDE&&fiblet_last(words)>0u){
width=fiblet_step(words)&7u;
if(width==0u){
lo=ivec3(0);
width=FIBLET_PLAIN_BYTES;
return;
}
lo=ivec3(codes_at(byte),codes_at(byte + 4u),codes_at(byte + 8u));
n=uvec2(codes_at(byte + 12u),codes_at(byte + 16u));
byte +=FIBLET_WIDE_HEADER;
}
#endif
}
ivec3 lattice_cell(uint byte,uint width,ivec3 lo,uvec2 n){
#if FEATURE_WIDE_LATTICE
if(width==FIBLET_PLAIN_BYTES)return lo + ivec3(codes_at(byte),codes_at(byte + 4u),codes_at(byte + 8u));
#endif
uint code=codes_at(byte)&(0xFFFFFFFFu>>(32u - 8u*width));
uint row=code/n.x;
return lo + ivec3(code - row*n.x,row%n.y,row/n.y);
}
#endif
struct Walk{
uint last;
uint kind;
uint byte;
uint cap;
float scale;
float step;
uint width;
uvec2 n;
ivec3 lo;
ivec3 k;
};
Walk walk;
vec3 walk_anchor;
vec3 walk_point;
vec3 walk_delta;
vec4 walk_frame;
#if __VERSION__ >= 400
precise walk_anchor;
precise walk_point;
precise walk_delta;
precise walk_frame;
#endif
void walk_begin(uint f){
uvec3 words=decoding_words(f);
walk_anchor=anchor_local(f);
walk_point=walk_anchor;
walk_delta=vec3(0.0);
walk.last=fiblet_last(words);
walk.kind=fiblet_kind(words);
walk.byte=first_code(f,words);
#if FEATURE_DIRECTION
walk.cap=fiblet_cap(words);
walk.scale=rotation_scale(walk.cap);
walk.step=step_length(words);
walk_frame=first_frame(fiblet_shape(words));
#endif
#if FEATURE_LATTICE
if(walk.kind!=KIND_DIRECTION){
walk.k=ivec3(0);
walk.step=lattice_edge*exp2(-float(fiblet_cap(words)));
lattice_box(words,walk.byte,walk.lo,walk.n,walk.width);
}
#endif
}
void walk_next(uint i){
#if FEATURE_LATTICE
if(walk.kind!=KIND_DIRECTION){
ivec3 cell=lattice_cell(walk.byte,walk.width,walk.lo,walk.n);
walk.byte +=walk.width;
walk.k +=cell;
walk_delta=walk.step*vec3(cell);
walk_point=walk_anchor + walk.step*vec3(walk.k);
return;
}
#endif
#if FEATURE_DIRECTION
if(i>1u){
walk_frame=turned(walk_frame,rotation(walk.cap,code_at(walk.byte + i - 2u),walk.scale));
}
walk_delta=walk.step*rotated_x(walk_frame);
walk_point +=walk_delta;
#endif
}
struct Capsule{vec3 a;vec3 b;float r;float slip;};
float radius_of(uint f){return float(bitfieldExtract(bound_word(f>>1),int(f&1u)*16,16))*radius_scale;}
vec3 end_vector(uint f){
uint word=bound_word(chunk_end_words + rank_of(f)- chunk_first_rank);
precise vec3 v=end_vector_scale*vec3(fiblet_end_vector(word));
return v;
}
Capsule capsule_of(uint f){
precise vec3 a=anchor_local(f),b;
bool end=ends(f);
if(end)b=a + end_vector(f);
else b=anchor_local(f + 1u);
return Capsule(a,b,radius_of(f),end?0.867*end_vector_scale:0.0);
}
float body_of(Capsule c){
#if FEATURE_TUBES
return c.r + tube_radius;
#else
return c.r;
#endif
}
float nearest_w(Capsule c){
vec4 row=vec4(window_from_local[0].w,window_from_local[1].w,window_from_local[2].w,window_from_local[3].w);
precise float wa=dot(row.xyz,c.a)+ row.w,wb=dot(row.xyz,c.b)+ row.w;
return min(wa,wb)- c.r*w_per_mm;
}
bool is_one_segment(Capsule c){
precise float scale=most_pixels_per_mm,w=nearest_w(c),length=distance(c.a,c.b);
return w>0.0&&(max(c.r,c.slip)*scale<=segment_deviation*w||(length + 2.0*c.r)*scale<=segment_size*w);
}
vec3 first_segment(uint f){
uvec3 words=decoding_words(f);
if(fiblet_last(words)==0u)return ends(f)?vec3(0.0):anchor_local(f + 1u)- anchor_local(f);
#if FEATURE_LATTICE
if(fiblet_kind(words)!=KIND_DIRECTION){
uint byte=first_code(f,words),width;
uvec2 n;
ivec3 lo;
lattice_box(words,byte,lo,n,width);
return lattice_edge*exp2(-float(fiblet_cap(words)))*vec3(lattice_cell(byte,width,lo,n));
}
#endif
#if FEATURE_DIRECTION
return step_length(words)*rotated_x(first_frame(fiblet_shape(words)));
#else
return vec3(0.0);
#endif
}
bool alike_after(uint f,bool whole){
#if FEATURE_POINT_MASK
return false;
#else
return!ends(f)&&f + 1u<chunk_fiblets&&is_one_segment(capsule_of(f + 1u))==whole;
#endif
}
vec3 direction_before(uint f,bool whole){
return!whole||f==0u||begins(f)?vec3(0.0):anchor_local(f)- anchor_local(f - 1u);
}
vec3 direction_after(uint f,bool whole){
if(ends(f)||f + 1u>=chunk_fiblets)return vec3(0.0);
if(!whole)return first_segment(f + 1u);
return ends(f + 1u)?end_vector(f + 1u):anchor_local(f + 2u)- anchor_local(f + 1u);
}
uint packed_direction(vec3 d){
float norm=abs(d.x)+ abs(d.y)+ abs(d.z);
vec2 s=d.yz/norm;
if(d.x<0.0)s=(1.0 - abs(s.yx))*vec2(s.x<0.0?-1.0:1.0,s.y<0.0?-1.0:1.0);
ivec2 i=ivec2(round(clamp(s,-1.0,1.0)*FIBLET_DIRECTION_SCALE));
return uint(i.x&0xFFFF)|(uint(i.y)<<16u);
}
uint packed_tangent(vec3 delta,uint before){
float size=max(abs(delta.x),max(abs(delta.y),abs(delta.z)));
return size>0.0?packed_direction(delta/size):before;
}
vec3 unit_or_none(vec3 d){
float size=max(abs(d.x),max(abs(d.y),abs(d.z)));
return size>0.0?normalize(d/size):vec3(0.0);
}
vec3 mean_direction(vec3 before,vec3 after){
vec3 sum=before + after;
float square=dot(sum,sum);
return square>1e-6?sum*inversesqrt(square):before;
}
struct Tangents{vec3 start;vec3 end;};
Tangents tangents_of(vec3 before,vec3 here,vec3 after,bool leads){
Tangents t=Tangents(mean_direction(before,here),vec3(0.0));
if(here!=vec3(0.0))before=here;
t.end=leads&&after!=vec3(0.0)?after:mean_direction(before,after);
if(t.start==vec3(0.0))t.start=t.end;
return t;
}
vec3 tangent_between(Tangents ends,float t){
vec3 d=mix(ends.start,ends.end,t);
return dot(d,d)>1e-6?d:ends.start;
}
uvec2 packed_tangents(Tangents ends){return uvec2(packed_tangent(ends.start,0u),packed_tangent(ends.end,0u));}
vec3 unpacked_tangent(uint word){
ivec2 s=ivec2(int(word<<16)>>16,int(word)>>16);
vec2 p=vec2(s)/FIBLET_DIRECTION_SCALE;
float x=1.0 - abs(p.x)- abs(p.y);
if(x<0.0)p=(1.0 - abs(p.yx))*vec2(s.x<0?-1.0:1.0,s.y<0?-1.0:1.0);
return normalize(vec3(x,p));
}
Tangents unpacked_tangents(uvec2 words){return Tangents(unpacked_tangent(words.x),unpacked_tangent(words.y));}
layout(location=0)in uvec2 item;
uniform uint share_size;
flat out uvec4 o0;flat out uvec4 o1;flat out uvec4 o2;flat out uvec4 o3;flat out uvec4 o4;flat out uvec4 o5;
flat out uvec4 o6;flat out uvec4 o7;flat out uvec4 o8;flat out uvec4 o9;flat out uvec4 o10;flat out uvec4 o11;
flat out uvec4 o12;flat out uvec4 o13;flat out uvec4 o14;
uvec4 slots[15];
uvec4 slot(vec3 point,vec3 tangent){return uvec4(floatBitsToUint(point),packed_tangent(tangent,0u));}
void main(){
uint f=item.x,first=item.y*share_size,stop=first + share_size;
bool end=ends(f);
walk_begin(f);
uint last=walk.last;
vec3 point=walk_point,next=end||f + 1u>=chunk_fiblets?vec3(0.0):anchor_local(f + 1u),before=vec3(0.0),tangent;
for(uint i=0u;i<=min(last,stop - 1u);++i){
vec3 here=point,run;
if(i<last){
walk_next(i + 1u);
run=walk_delta;
point=walk_point;
}else run=end?vec3(0.0):next - here;
vec3 along=unit_or_none(run);
tangent=i==0u?along:mean_direction(before,along);
if(i>=first)slots[i - first]=slot(here,tangent);
if(along!=vec3(0.0))before=along;
}
if(last + 1u<stop){
vec3 beyond=vec3(0.0);
if(end)next=point;
else beyond=direction_after(f,false);
if(end&&last==0u&&!begins(f)&&f>0u){
walk_begin(f - 1u);
for(uint i=1u;i<=walk.last;++i)walk_next(i);
tangent=unit_or_none(next - walk_point);
if(first==0u)slots[0]=slot(next,tangent);
}else if(beyond!=vec3(0.0))tangent=unit_or_none(beyond);
for(uint i=max(last + 1u,first);i<stop;++i)slots[i - first]=slot(i==last + 1u?next:next + beyond,tangent);
}
o0=slots[0];o1=slots[1];o2=slots[2];o3=slots[3];o4=slots[4];o5=slots[5];o6=slots[6];o7=slots[7];
o8=slots[8];o9=slots[9];o10=slots[10];o11=slots[11];o12=slots[12];o13=slots[13];o14=slots[14];
gl_Position=vec4(0.0);
}
`,"page/image.frag":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
in vec2 at;
uniform highp sampler2D pixels;
uniform float opacity;
layout(location=0)out vec4 colour;
void main(){
colour=texture(pixels,at);
if(colour.a==0.0)discard;
colour.a*=opacity;
}
`,"page/image.vert":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
uniform mat4 clip_from_data;
uniform vec3 corner;
uniform vec3 across;
uniform vec3 up;
out vec2 at;
void main(){
at=vec2(gl_VertexID&1,gl_VertexID>>1);
gl_Position=clip_from_data*vec4(corner + at.x*across + at.y*up,1.0);
}
`,"page/none.frag":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
out vec4 colour;
void main(){colour=vec4(0.0);}
`,"page/resolve.frag":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
const uint FIBLET_MAX_POINTS=60u;
const uint FIBLET_PAGE_BITS=14u;
const uint FIBLET_CAPS=16u;
const float FIBLET_DIRECTION_SCALE=32767.0;
const float FIBLET_STEP_LEVELS=1023.0;
const uint FIBLET_WIDE_HEADER=20u;
const uint FIBLET_PLAIN_BYTES=12u;
const uint FIBLET_ANCHORS_WORDS=2u;
const uint FIBLET_DECODING_WORDS=3u;
const uint KIND_DIRECTION=0u;
const uint KIND_LATTICE8=1u;
const uint KIND_LATTICE16=2u;
const uint KIND_WIDE=3u;
uint fiblet_anchor_x(uvec2 words){return bitfieldExtract(words.x,0,16);}
uint fiblet_anchor_y(uvec2 words){return bitfieldExtract(words.x,16,16);}
uint fiblet_anchor_z(uvec2 words){return bitfieldExtract(words.y,0,16);}
uint fiblet_rank(uvec2 words){return bitfieldExtract(words.y,16,14);}
uint fiblet_begin(uvec2 words){return bitfieldExtract(words.y,30,1);}
uint fiblet_end(uvec2 words){return bitfieldExtract(words.y,31,1);}
uint fiblet_shape(uvec3 words){return bitfieldExtract(words.x,0,32);}
uint fiblet_code(uvec3 words){return bitfieldExtract(words.y,0,22);}
uint fiblet_step(uvec3 words){return bitfieldExtract(words.y,22,10);}
uint fiblet_point(uvec3 words){return bitfieldExtract(words.z,0,20);}
uint fiblet_last(uvec3 words){return bitfieldExtract(words.z,20,6);}
uint fiblet_cap(uvec3 words){return bitfieldExtract(words.z,26,4);}
uint fiblet_kind(uvec3 words){return bitfieldExtract(words.z,30,2);}
ivec3 fiblet_end_vector(uint word){return ivec3(bitfieldExtract(int(word),0,10),bitfieldExtract(int(word),10,10),bitfieldExtract(int(word),20,10));}
uint packed_direction(vec3 d){
float norm=abs(d.x)+ abs(d.y)+ abs(d.z);
vec2 s=d.yz/norm;
if(d.x<0.0)s=(1.0 - abs(s.yx))*vec2(s.x<0.0?-1.0:1.0,s.y<0.0?-1.0:1.0);
ivec2 i=ivec2(round(clamp(s,-1.0,1.0)*FIBLET_DIRECTION_SCALE));
return uint(i.x&0xFFFF)|(uint(i.y)<<16u);
}
uint packed_tangent(vec3 delta,uint before){
float size=max(abs(delta.x),max(abs(delta.y),abs(delta.z)));
return size>0.0?packed_direction(delta/size):before;
}
vec3 unit_or_none(vec3 d){
float size=max(abs(d.x),max(abs(d.y),abs(d.z)));
return size>0.0?normalize(d/size):vec3(0.0);
}
vec3 mean_direction(vec3 before,vec3 after){
vec3 sum=before + after;
float square=dot(sum,sum);
return square>1e-6?sum*inversesqrt(square):before;
}
struct Tangents{vec3 start;vec3 end;};
Tangents tangents_of(vec3 before,vec3 here,vec3 after,bool leads){
Tangents t=Tangents(mean_direction(before,here),vec3(0.0));
if(here!=vec3(0.0))before=here;
t.end=leads&&after!=vec3(0.0)?after:mean_direction(before,after);
if(t.start==vec3(0.0))t.start=t.end;
return t;
}
vec3 tangent_between(Tangents ends,float t){
vec3 d=mix(ends.start,ends.end,t);
return dot(d,d)>1e-6?d:ends.start;
}
uvec2 packed_tangents(Tangents ends){return uvec2(packed_tangent(ends.start,0u),packed_tangent(ends.end,0u));}
vec3 unpacked_tangent(uint word){
ivec2 s=ivec2(int(word<<16)>>16,int(word)>>16);
vec2 p=vec2(s)/FIBLET_DIRECTION_SCALE;
float x=1.0 - abs(p.x)- abs(p.y);
if(x<0.0)p=(1.0 - abs(p.yx))*vec2(s.x<0?-1.0:1.0,s.y<0?-1.0:1.0);
return normalize(vec3(x,p));
}
Tangents unpacked_tangents(uvec2 words){return Tangents(unpacked_tangent(words.x),unpacked_tangent(words.y));}
const int MOST_LIGHTS=8;
uniform int light_count;
uniform vec3 light_colour[MOST_LIGHTS];
uniform vec4 light_place[MOST_LIGHTS];
uniform vec3 light_sum;
uniform float light_standing;
vec3 to_light(int i,vec3 place){return normalize(light_place[i].xyz - light_place[i].w*place);}
float across_line(vec3 tangent,vec3 d){
float along=dot(tangent,d);
along*=along;
return max(0.0,1.0 - along*along);
}
vec3 light_on_line(vec3 own,vec3 tangent,vec3 place,bool illuminated,vec4 reflects,vec3 sheen){
vec3 sight=normalize(-place),normal=sight - tangent*dot(tangent,sight);
normal=length(normal)>1e-3?normalize(normal):sight;
vec3 diffuse=vec3(0.0),shine=vec3(0.0);
for(int i=0;i<light_count;++i){
vec3 l=to_light(i,place);
float along=dot(tangent,l),sine=sqrt(max(0.0,1.0 - along*along));
diffuse +=light_colour[i]*(illuminated?sine:across_line(tangent,l));
if(reflects.z>0.0){
float spread=illuminated?sine:sqrt(max(0.0,1.0 - along*along));
vec3 back=-along*tangent + spread*normal;
shine +=light_colour[i]*pow(max(1e-5,dot(back,sight)),reflects.w);
}
}
vec3 on;
if(illuminated)on=diffuse/max(1.0,max(light_sum.r,max(light_sum.g,light_sum.b)));
else{
float brightest=max(light_sum.r,max(light_sum.g,light_sum.b));
vec3 tint=light_sum/max(brightest,1e-6);
tint=mix(vec3(1.0),tint,1.0 - min(tint.r,min(tint.g,tint.b)));
vec3 share=min(diffuse/max(light_sum,vec3(1e-6)),vec3(1.0));
share=mix(vec3(across_line(tangent,vec3(-0.57735027,0.57735027,0.57735027))),share,light_standing);
on=min(brightest,1.0)*tint*mix(vec3(0.6),vec3(1.0),share);
}
return reflects.x*own + reflects.y*on*own + reflects.z*sheen*shine;
}
vec3 light_on_surface(vec3 own,vec3 normal,vec3 place,vec4 reflects,vec3 sheen){
vec3 diffuse=vec3(0.0),shine=vec3(0.0),sight=normalize(-place);
for(int i=0;i<light_count;++i){
vec3 l=to_light(i,place);
float facing=max(0.0,dot(normal,l));
diffuse +=facing*light_colour[i];
if(reflects.z>0.0&&facing>0.0)shine +=light_colour[i]*pow(max(0.0,dot(reflect(-l,normal),sight)),reflects.w);
}
return reflects.x*own + reflects.y*diffuse*own + reflects.z*sheen*shine;
}
uniform highp sampler2D table;
uniform vec4 table_range;
uniform int logarithm;
vec4 of_value(float value){
int n=int(table_range.w),entry;
if((floatBitsToUint(value)&0x7FFFFFFFu)>0x7F800000u)entry=n + 2;
else{
if(logarithm==1)value=value>0.0?log(value)*0.4342944819032518:-3.0e38;
if(value<table_range.x)entry=n;
else if(value>table_range.y)entry=n + 1;
else entry=int(min((value - table_range.x)*table_range.z,float(n - 1)));
}
return texelFetch(table,ivec2(entry&4095,entry>>12),0);
}
uniform highp usampler2D texels;
uniform highp sampler2D depths;
uniform highp sampler2D colours;
uniform uint layer;
uniform int mode;
uniform vec3 one_colour;
uniform int light;
uniform vec4 reflects;
uniform vec3 sheen;
uniform uint marked;
uniform mat3 data_to_view;
uniform mat4 pixel_to_view;
uniform float parallel;
uniform vec2 picture;
layout(location=0)out vec4 colour;
void main(){
ivec2 pixel=ivec2(gl_FragCoord.xy);
uvec4 word=texelFetch(texels,pixel,0);
if(word.y==0xFFFFFFFFu&&word.x==0xFFFFFFFFu||(word.x&0xF0000000u)!=layer)discard;
uint streamline=word.x&0x0FFFFFFFu;
vec3 tangent=unpacked_tangent(word.y);
vec4 own=vec4(one_colour,1.0);
if(mode==0)own=vec4(abs(tangent),1.0);
else if(mode==2)own=texelFetch(colours,ivec2(int(streamline&4095u),int(streamline>>12u)),0);
else if(mode==3)own=of_value(uintBitsToFloat(word.w));
else if(mode==4)own=unpackUnorm4x8(word.w);
if(own.a==0.0)discard;
vec3 lit=own.rgb;
if(light!=0){
vec2 ndc=2.0*(vec2(pixel)+ 0.5)/picture - 1.0;
vec4 place=pixel_to_view*vec4(ndc,2.0*texelFetch(depths,pixel,0).r - 1.0,1.0);
lit=light_on_line(own.rgb,normalize(data_to_view*tangent),place.xyz/place.w,light==2,reflects,sheen);
}
if(streamline==marked)lit=mix(lit,vec3(1.0,0.9,0.2),0.75);
colour=vec4(lit,1.0);
}
`,"page/screen.vert":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
void main(){gl_Position=vec4(gl_VertexID==1?3.0:-1.0,gl_VertexID==2?3.0:-1.0,0.0,1.0);}
`,"page/segment.frag":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define FEATURE_CLIPPING 1
#define FEATURE_CLIPPING_DEPTH 1
#define FEATURE_CLIP_PLANES 1
#define FEATURE_TUBES 0
#define FEATURE_VALUES_COLOUR 1
#define FEATURE_VALUES_STORED 1
#define FEATURE_WIDE_LINES 1
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
layout(std140)uniform Frame{
mat4 window_from_local;
vec4 view_planes[6];
uvec3 reference;
float half_line_width;
vec2 viewport;
float line_reach;
float plane_rounding;
float most_pixels_per_mm;
float w_per_mm;
float segment_deviation;
float segment_size;
};
#if FEATURE_TUBES
#endif
vec4 to_homogeneous(vec3 p){
precise vec4 c=window_from_local[0]*p.x + window_from_local[1]*p.y + window_from_local[2]*p.z
+ window_from_local[3];
return c;
}
vec3 above_lower(vec4 c){
precise vec3 d=c.xyz + vec3(vec2(half_line_width),0.0)*c.w;
return d;
}
vec3 below_upper(vec4 c){
precise vec3 d=vec3(viewport + half_line_width,1.0)*c.w - c.xyz;
return d;
}
bool in_volume(vec4 c){
return all(greaterThanEqual(above_lower(c),vec3(0.0)))&&all(greaterThanEqual(below_upper(c),vec3(0.0)));
}
vec4 to_window(vec4 c){
precise float r=1.0/max(c.w,1e-30);
precise vec4 window=vec4(c.xyz*r,c.w);
return window;
}
bool clip_segment(vec4 a,vec4 b,out float t0,out float t1){
t0=0.0;
t1=1.0;
vec3 a_low=above_lower(a),a_high=below_upper(a),b_low=above_lower(b),b_high=below_upper(b);
for(int side=0;side<6;++side){
int axis=side>>1;
float da=(side&1)==0?a_low[axis]:a_high[axis],db=(side&1)==0?b_low[axis]:b_high[axis];
if(da<0.0&&db<0.0)return false;
precise float t=da/(da - db);
if(da<0.0)t0=max(t0,t);
else if(db<0.0)t1=min(t1,t);
}
return t0<=t1;
}
bool clip_window(vec2 a,vec2 b,out float t0,out float t1){
vec2 margin=vec2(half_line_width),run=b - a;
precise vec2 inverse=1.0/mix(run,vec2(1e-20),equal(run,vec2(0.0)));
precise vec2 low=(-margin - a)*inverse,high=(viewport + margin - a)*inverse;
vec2 enter=min(low,high),leave=max(low,high);
t0=clamp(max(enter.x,enter.y),0.0,1.0);
t1=clamp(min(leave.x,leave.y),0.0,1.0);
return max(enter.x,enter.y)<=min(leave.x,leave.y)&&min(leave.x,leave.y)>=0.0&&max(enter.x,enter.y)<=1.0;
}
uint depth_key(float z){return uint(int(clamp(z,0.0,0.99999988)*2147483648.0))<<1u;}
const vec2 CELL_SHIFT=vec2(23.0,23.0)/256.0;
vec2 in_picture(vec4 window){
#if FEATURE_CLIPPING
return clamp(window.xy,vec2(0.0),viewport - 0.01);
#else
return window.xy;
#endif
}
vec2 pixel_of(vec4 window){return floor(in_picture(window));}
struct Cells{
ivec2 first;
vec2 run;
int count;
float shift;
float inverse;
float square;
};
Cells cells_between(ivec2 p,ivec2 q){
ivec2 run=q - p,size=abs(run);
int n=max(size.x,size.y);
bool steep=size.y>size.x;
float shift=steep?(run.y<0?-CELL_SHIFT.y:CELL_SHIFT.y):(run.x<0?-CELL_SHIFT.x:CELL_SHIFT.x);
vec2 way=vec2(run);
return Cells(p,way,n,shift,1.0/float(max(n,1)),1.0/max(dot(way,way),1.0));
}
#if FEATURE_CLIP_PLANES
layout(std140)uniform ClipPlanes{
vec4 clip_planes[8];
vec2 clip_tilts[8];
float clip_brushes[8];
int clip_plane_count;
float clip_rounding;
};
float clip_height_of(int plane,vec3 p){
precise float h=dot(clip_planes[plane].xyz,p)+ clip_planes[plane].w;
return h;
}
float clip_height(vec3 p){
float least=clip_height_of(0,p);
for(int plane=1;plane<clip_plane_count;++plane)least=min(least,clip_height_of(plane,p));
return least;
}
bool clip_touches(vec3 centre,float radius){
float margin=radius + 2.0*clip_rounding;
float w=window_from_local[0].w*centre.x + window_from_local[1].w*centre.y + window_from_local[2].w*centre.z;
w=max(w + window_from_local[3].w + radius*w_per_mm,0.0);
for(int plane=0;plane<clip_plane_count;++plane){
if(clip_height_of(plane,centre)<margin + w*clip_brushes[plane])return true;
}
return false;
}
bool clip_by_planes(vec3 a,vec3 b,inout float t0,inout float t1){
for(int plane=0;plane<clip_plane_count;++plane){
precise float ha=clip_height_of(plane,a),hb=clip_height_of(plane,b);
if(ha<0.0&&hb<0.0)return false;
precise float t=ha/(ha - hb);
if(ha<0.0)t0=max(t0,t);
else if(hb<0.0)t1=min(t1,t);
}
return t0<=t1;
}
bool on_kept_side(vec3 p){return clip_height(p)>=0.0;}
#else
bool clip_by_planes(vec3 a,vec3 b,inout float t0,inout float t1){return true;}
bool on_kept_side(vec3 p){return true;}
#endif
#if FEATURE_TUBES
#endif
struct Vertex{
vec3 local;
vec4 clip;
vec4 window;
bool inside;
};
struct ClippedSegment{
vec4 a;
vec4 b;
float t0;
float t1;
bool start;
bool cap;
float reach;
bool thin;
};
Vertex vertex_of(vec3 p){
precise vec4 clip=to_homogeneous(p);
precise vec4 window=to_window(clip);
bool inside=true;
#if FEATURE_CLIPPING_DEPTH
inside=in_volume(clip)&&on_kept_side(p);
#endif
return Vertex(p,clip,window,inside);
}
bool clip_in_space(Vertex from,Vertex to,inout ClippedSegment piece){
if(from.inside&&to.inside)return true;
float t0,t1;
if(!clip_segment(from.clip,to.clip,t0,t1))return false;
if(!clip_by_planes(from.local,to.local,t0,t1))return false;
if(t0>0.0)piece.a=to_window(from.clip + t0*(to.clip - from.clip));
if(t1<1.0)piece.b=to_window(from.clip + t1*(to.clip - from.clip));
piece=ClippedSegment(piece.a,piece.b,t0,t1,piece.start||t0>0.0,piece.cap||t1<1.0,0.0,false);
return true;
}
bool clip_in_window(Vertex from,Vertex to,inout ClippedSegment piece){
float t0,t1;
bool any_part=clip_window(from.window.xy,to.window.xy,t0,t1);
precise vec4 run=to.window - from.window,a=from.window + t0*run,b=t1<1.0?from.window + t1*run:to.window;
piece=ClippedSegment(a,b,t0,t1,piece.start||t0>0.0,piece.cap||t1<1.0,0.0,false);
return any_part;
}
bool piece_of(Vertex from,Vertex to,bool start,bool cap,out ClippedSegment piece){
piece=ClippedSegment(from.window,to.window,0.0,1.0,start,cap,0.0,false);
#if FEATURE_TUBES
Outline outline;
bool any_part=outline_of(from.clip,to.clip,outline);
piece=ClippedSegment(outline.a,outline.b,outline.t0,outline.t1,start,cap,outline.reach,outline.thin);
return any_part;
#elif FEATURE_CLIPPING_DEPTH
return clip_in_space(from,to,piece);
#elif FEATURE_CLIPPING
return clip_in_window(from,to,piece);
#else
return true;
#endif
}
bool piece_of(vec3 from,vec3 to,bool start,bool cap,out ClippedSegment piece){
return piece_of(vertex_of(from),vertex_of(to),start,cap,piece);
}
float corrected(float s,vec2 w){
return clamp(s*w.x/max((1.0 - s)*w.y + s*w.x,1e-30),0.0,1.0);
}
float along_segment(Vertex from,Vertex to,ClippedSegment piece,float s){
#if FEATURE_TUBES
return s;
#elif FEATURE_CLIPPING_DEPTH
return mix(piece.t0,piece.t1,corrected(s,vec2(piece.a.w,piece.b.w)));
#elif FEATURE_CLIPPING
return corrected(mix(piece.t0,piece.t1,s),vec2(from.window.w,to.window.w));
#else
return corrected(s,vec2(piece.a.w,piece.b.w));
#endif
}
const float EDGE_STEPS=448.0;
const float EDGE_LEAST=2.0;
const float WIDTH_STEPS=32.0;
uint packed_edges(vec2 n,float e,float w,uint end){
vec2 q=n/max(abs(n.x)+ abs(n.y),1e-30);
int turn=int((q.y>=0.0?1.0 - q.x:3.0 + q.x)*512.0 + 0.5)&2047;
int inside=int(clamp((e + EDGE_LEAST)*EDGE_STEPS + 0.5,0.0,2047.0));
int across=int(clamp(w*WIDTH_STEPS + 0.5,1.0,127.0));
return uint(turn|(inside<<11)|(across<<22))|(end<<29u);
}
struct Edges{
vec2 n;
float e;
float w;
uint end;
float stop;
};
Edges unpacked_edges(uint word){
float turn=float(int(word&2047u))/512.0,x=abs(turn - 2.0)- 1.0;
int width=int((word>>22u)&127u),end=int(word>>29u);
return Edges(normalize(vec2(x,turn<2.0?1.0 - abs(x):abs(x)- 1.0)),
float(int((word>>11u)&2047u))/EDGE_STEPS - EDGE_LEAST,width==127?128.0:float(width)/WIDTH_STEPS,
uint(end),float(end>3?end - 5:end - 2)/3.0);
}
#if FEATURE_TUBES || FEATURE_WIDE_LINES
uint capsule_edges(vec2 centre,vec2 run,float r){
vec2 away=centre - clamp(dot(centre,run)/max(dot(run,run),1e-12),0.0,1.0)*run;
float size=length(away);
vec2 n=size>1e-4?away/size:vec2(-run.y,run.x)/max(length(run),1e-6);
return packed_edges(n,r - size,2.0*r,0u);
}
#endif
#if FEATURE_TUBES
uint thin_tube_edges(Tube t,vec2 centre,vec2 run,float r){
float square=dot(run,run),foot=dot(centre,run)/max(square,1e-12);
foot=square>1e-6?clamp(foot,t.start?0.0:-1e6,t.cap?1.0:1e6):clamp(foot,0.0,1.0);
vec2 away=centre - foot*run;
float size=length(away);
vec2 n=size>1e-4?away/size:vec2(-run.y,run.x)/max(length(run),1e-6);
return packed_edges(n,r - size,2.0*r,0u);
}
uint tube_edges(Tube t,vec4 c0,vec4 c1,vec2 pixel,Hit hit){
vec3 d=normalize(tube_ray + tube_perspective*(pixel.x*tube_ray_x + pixel.y*tube_ray_y)),face=d;
if(hit.t>0.0&&hit.t<1.0){
vec3 across=d - dot(d,t.axis)*t.axis;
if(dot(across,across)>1e-4)face=normalize(across);
}
vec3 beside=hit.normal - dot(hit.normal,face)*face;
float share=length(beside);
vec3 out_of=share>1e-4?beside/share:normalize(tube_ray_x);
vec3 at=hit.t*t.size*t.axis + tube_radius*hit.normal;
vec2 way=vec2(dot(window_gradient(0),out_of),dot(window_gradient(1),out_of))- pixel*dot(window_gradient(3),out_of);
float pixels=length(way),r=tube_radius*pixels/max(c0.w + dot(window_gradient(3),at),1e-30);
Outline outline;
if(r<half_line_width&&outline_of(c0,c1,outline))return thin_tube_edges(t,pixel - outline.a.xy,outline.b.xy - outline.a.xy,r);
return packed_edges(pixels>0.0?way/pixels:vec2(1.0,0.0),(1.0 - share)*r,2.0*r,0u);
}
#endif
#if !(FEATURE_TUBES || FEATURE_WIDE_LINES)
vec4 parts_of(ClippedSegment piece){
vec4 at=vec4(in_picture(piece.a),in_picture(piece.b));
return floor((at - floor(at))*256.0)/256.0;
}
uint packed_parts(ClippedSegment piece){
uvec4 parts=uvec4(parts_of(piece)*256.0);
return parts.x|(parts.y<<8u)|(parts.z<<16u)|(parts.w<<24u);
}
uint thin_edges(ivec2 first,ivec2 last,vec2 at,vec4 parts,bool start,bool cap){
vec2 run=vec2(last - first),a=parts.xy - 0.5 - at,d=run + parts.zw - parts.xy;
float square=dot(d,d),shrink=inversesqrt(max(square,1e-6));
vec2 along=square>1e-6?d:vec2(1.0,0.0);
float left=(along.y*a.x - along.x*a.y)*shrink;
bool turned=left<0.0,begins=start&&at==vec2(0.0),ends=cap&&at==run;
float stop=dot(along,begins?a:a + d)*shrink;
uint third=uint(int(2.5 + clamp(turned?3.0*stop:-3.0*stop,-1.0,1.0)));
uint end=begins&&ends?7u:begins||ends?(turned==ends?third:third + 3u):0u;
return packed_edges(turned?vec2(along.y,-along.x):vec2(-along.y,along.x),0.5 - abs(left),1.0,end);
}
vec4 unpacked_parts(uint word){return vec4((uvec4(word)>>uvec4(0u,8u,16u,24u))&255u)/256.0;}
#endif
const float JOINT_LEAST=0.1,JOINT_OVERLAP=0.05;
const uint NO_ONWARD=0x80008000u;
vec2 onward_at(vec4 end,vec3 ahead){
vec4 c=window_from_local[0]*ahead.x + window_from_local[1]*ahead.y + window_from_local[2]*ahead.z;
vec2 run=c.xy - end.xy*c.w;
float size=length(run);
return size>JOINT_LEAST*end.w?run/size:vec2(0.0);
}
bool beyond_joint(vec2 onward,vec2 away){return dot(onward,away)>JOINT_OVERLAP;}
uint packed_onward(vec2 onward){
if(onward==vec2(0.0))return NO_ONWARD;
ivec2 s=ivec2(round(32767.0*onward));
return uint(s.x&0xFFFF)|(uint(s.y)<<16u);
}
vec2 unpacked_onward(uint word){
return word==NO_ONWARD?vec2(0.0):vec2(ivec2(int(word<<16)>>16,int(word)>>16))/32767.0;
}
const uint FIBLET_MAX_POINTS=60u;
const uint FIBLET_PAGE_BITS=14u;
const uint FIBLET_CAPS=16u;
const float FIBLET_DIRECTION_SCALE=32767.0;
const float FIBLET_STEP_LEVELS=1023.0;
const uint FIBLET_WIDE_HEADER=20u;
const uint FIBLET_PLAIN_BYTES=12u;
const uint FIBLET_ANCHORS_WORDS=2u;
const uint FIBLET_DECODING_WORDS=3u;
const uint KIND_DIRECTION=0u;
const uint KIND_LATTICE8=1u;
const uint KIND_LATTICE16=2u;
const uint KIND_WIDE=3u;
uint fiblet_anchor_x(uvec2 words){return bitfieldExtract(words.x,0,16);}
uint fiblet_anchor_y(uvec2 words){return bitfieldExtract(words.x,16,16);}
uint fiblet_anchor_z(uvec2 words){return bitfieldExtract(words.y,0,16);}
uint fiblet_rank(uvec2 words){return bitfieldExtract(words.y,16,14);}
uint fiblet_begin(uvec2 words){return bitfieldExtract(words.y,30,1);}
uint fiblet_end(uvec2 words){return bitfieldExtract(words.y,31,1);}
uint fiblet_shape(uvec3 words){return bitfieldExtract(words.x,0,32);}
uint fiblet_code(uvec3 words){return bitfieldExtract(words.y,0,22);}
uint fiblet_step(uvec3 words){return bitfieldExtract(words.y,22,10);}
uint fiblet_point(uvec3 words){return bitfieldExtract(words.z,0,20);}
uint fiblet_last(uvec3 words){return bitfieldExtract(words.z,20,6);}
uint fiblet_cap(uvec3 words){return bitfieldExtract(words.z,26,4);}
uint fiblet_kind(uvec3 words){return bitfieldExtract(words.z,30,2);}
ivec3 fiblet_end_vector(uint word){return ivec3(bitfieldExtract(int(word),0,10),bitfieldExtract(int(word),10,10),bitfieldExtract(int(word),20,10));}
uint packed_direction(vec3 d){
float norm=abs(d.x)+ abs(d.y)+ abs(d.z);
vec2 s=d.yz/norm;
if(d.x<0.0)s=(1.0 - abs(s.yx))*vec2(s.x<0.0?-1.0:1.0,s.y<0.0?-1.0:1.0);
ivec2 i=ivec2(round(clamp(s,-1.0,1.0)*FIBLET_DIRECTION_SCALE));
return uint(i.x&0xFFFF)|(uint(i.y)<<16u);
}
uint packed_tangent(vec3 delta,uint before){
float size=max(abs(delta.x),max(abs(delta.y),abs(delta.z)));
return size>0.0?packed_direction(delta/size):before;
}
vec3 unit_or_none(vec3 d){
float size=max(abs(d.x),max(abs(d.y),abs(d.z)));
return size>0.0?normalize(d/size):vec3(0.0);
}
vec3 mean_direction(vec3 before,vec3 after){
vec3 sum=before + after;
float square=dot(sum,sum);
return square>1e-6?sum*inversesqrt(square):before;
}
struct Tangents{vec3 start;vec3 end;};
Tangents tangents_of(vec3 before,vec3 here,vec3 after,bool leads){
Tangents t=Tangents(mean_direction(before,here),vec3(0.0));
if(here!=vec3(0.0))before=here;
t.end=leads&&after!=vec3(0.0)?after:mean_direction(before,after);
if(t.start==vec3(0.0))t.start=t.end;
return t;
}
vec3 tangent_between(Tangents ends,float t){
vec3 d=mix(ends.start,ends.end,t);
return dot(d,d)>1e-6?d:ends.start;
}
uvec2 packed_tangents(Tangents ends){return uvec2(packed_tangent(ends.start,0u),packed_tangent(ends.end,0u));}
vec3 unpacked_tangent(uint word){
ivec2 s=ivec2(int(word<<16)>>16,int(word)>>16);
vec2 p=vec2(s)/FIBLET_DIRECTION_SCALE;
float x=1.0 - abs(p.x)- abs(p.y);
if(x<0.0)p=(1.0 - abs(p.yx))*vec2(s.x<0?-1.0:1.0,s.y<0?-1.0:1.0);
return normalize(vec3(x,p));
}
Tangents unpacked_tangents(uvec2 words){return Tangents(unpacked_tangent(words.x),unpacked_tangent(words.y));}
#define VARYING flat in
#ifndef VARYING
#define VARYING flat out
#endif
VARYING uvec4 seg_ids;
VARYING vec4 seg_start;
VARYING vec4 seg_end;
VARYING vec4 seg_along;
#if FEATURE_VALUES_COLOUR
VARYING uvec2 seg_colours;
#endif
#if FEATURE_WIDE_LINES
VARYING vec2 seg_onward;
#if FEATURE_CLIP_PLANES
VARYING vec3 seg_from;
VARYING vec3 seg_to;
#endif
#endif
const bool SPRITES=false;
layout(location=0)out uvec4 out_texel;
#if FEATURE_VALUES_STORED
uniform vec2 shown_values;
bool none(float value){return(floatBitsToUint(value)&0x7FFFFFFFu)>0x7F800000u;}
float value_between(float t){
vec2 ends=seg_along.zw;
if(none(ends.x)||none(ends.y))return t<0.5?ends.x:ends.y;
return mix(ends.x,ends.y,t);
}
#endif
void write(float s,uint edges){
float ratio=seg_start.w/max(seg_end.w,1e-30);
float t=mix(seg_along.x,seg_along.y,clamp(s*ratio/max(1.0 - s + s*ratio,1e-30),0.0,1.0));
Tangents ends=unpacked_tangents(seg_ids.yz);
uint bits=0u;
#if FEATURE_VALUES_STORED
float value=value_between(t);
if(shown_values.x<=shown_values.y&&!(value>=shown_values.x&&value<=shown_values.y))discard;
bits=floatBitsToUint(value);
#endif
#if FEATURE_VALUES_COLOUR
bits=packUnorm4x8(mix(unpackUnorm4x8(seg_colours.x),unpackUnorm4x8(seg_colours.y),t));
#endif
out_texel=uvec4(seg_ids.x,packed_tangent(tangent_between(ends,t),0u),edges,bits);
}
#if FEATURE_WIDE_LINES
#if FEATURE_CLIP_PLANES
bool brush_kept(float s,vec2 away){
for(int plane=0;plane<clip_plane_count;++plane){
vec2 heights=vec2(clip_height_of(plane,seg_from),clip_height_of(plane,seg_to));
vec2 h=max(heights/max(vec2(seg_start.w,seg_end.w),vec2(1e-30)),vec2(0.0));
if(h.x + s*(h.y - h.x)+ dot(clip_tilts[plane],away)<0.0)return false;
}
return true;
}
#endif
void main(){
vec2 run=seg_end.xy - seg_start.xy,centre=gl_FragCoord.xy - seg_start.xy;
float foot=dot(centre,run)/max(dot(run,run),1e-12),s=clamp(foot,0.0,1.0);
vec2 away=centre - s*run;
if(foot<0.0&&(seg_ids.w&1u)==0u||dot(away,away)>half_line_width*half_line_width)discard;
if(foot>1.0&&beyond_joint(seg_onward,centre - run))discard;
#if FEATURE_CLIP_PLANES
if(!brush_kept(s,away))discard;
#endif
gl_FragDepth=clamp(seg_start.z +(seg_end.z - seg_start.z)*s,0.0,0.99999988);
write(s,capsule_edges(centre,run,half_line_width));
}
#else
void main(){
vec2 first=pixel_of(seg_start),run=pixel_of(seg_end)- first,at=floor(gl_FragCoord.xy)- first;
Cells cells=cells_between(ivec2(first),ivec2(first + run));
bool start=(seg_ids.w&1u)!=0u,cap=(seg_ids.w&2u)!=0u,steep=abs(run.y)>abs(run.x);
float s=1.0;
if(at==run){
if(!cap)discard;
}else{
float major=steep?at.y:at.x,way=steep?run.y:run.x,steps=abs(major);
if(major*way<0.0||steps>=float(cells.count))discard;
vec2 line=floor(0.5 + CELL_SHIFT +(steps - cells.shift)*cells.inverse*run);
if(steep?line.x!=at.x:line.y!=at.y)discard;
s=dot(at - CELL_SHIFT,run)*cells.square;
}
if(SPRITES)gl_FragDepth=clamp(mix(seg_start.z,seg_end.z,s),0.0,0.99999988);
vec4 ends=vec4(in_picture(seg_start),in_picture(seg_end)),parts=floor((ends - floor(ends))*256.0)/256.0;
write(s,thin_edges(ivec2(first),ivec2(first + run),at,parts,start,cap));
}
#endif
`,"page/segment.vert":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define FEATURE_CLIPPING 1
#define FEATURE_CLIPPING_DEPTH 1
#define FEATURE_CLIP_PLANES 1
#define FEATURE_STREAMLINE_MASK 1
#define FEATURE_TUBES 0
#define FEATURE_VALUES_COLOUR 1
#define FEATURE_VALUES_STORED 1
#define FEATURE_WIDE_LINES 1
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
layout(std140)uniform Frame{
mat4 window_from_local;
vec4 view_planes[6];
uvec3 reference;
float half_line_width;
vec2 viewport;
float line_reach;
float plane_rounding;
float most_pixels_per_mm;
float w_per_mm;
float segment_deviation;
float segment_size;
};
#if FEATURE_TUBES
#endif
vec4 to_homogeneous(vec3 p){
precise vec4 c=window_from_local[0]*p.x + window_from_local[1]*p.y + window_from_local[2]*p.z
+ window_from_local[3];
return c;
}
vec3 above_lower(vec4 c){
precise vec3 d=c.xyz + vec3(vec2(half_line_width),0.0)*c.w;
return d;
}
vec3 below_upper(vec4 c){
precise vec3 d=vec3(viewport + half_line_width,1.0)*c.w - c.xyz;
return d;
}
bool in_volume(vec4 c){
return all(greaterThanEqual(above_lower(c),vec3(0.0)))&&all(greaterThanEqual(below_upper(c),vec3(0.0)));
}
vec4 to_window(vec4 c){
precise float r=1.0/max(c.w,1e-30);
precise vec4 window=vec4(c.xyz*r,c.w);
return window;
}
bool clip_segment(vec4 a,vec4 b,out float t0,out float t1){
t0=0.0;
t1=1.0;
vec3 a_low=above_lower(a),a_high=below_upper(a),b_low=above_lower(b),b_high=below_upper(b);
for(int side=0;side<6;++side){
int axis=side>>1;
float da=(side&1)==0?a_low[axis]:a_high[axis],db=(side&1)==0?b_low[axis]:b_high[axis];
if(da<0.0&&db<0.0)return false;
precise float t=da/(da - db);
if(da<0.0)t0=max(t0,t);
else if(db<0.0)t1=min(t1,t);
}
return t0<=t1;
}
bool clip_window(vec2 a,vec2 b,out float t0,out float t1){
vec2 margin=vec2(half_line_width),run=b - a;
precise vec2 inverse=1.0/mix(run,vec2(1e-20),equal(run,vec2(0.0)));
precise vec2 low=(-margin - a)*inverse,high=(viewport + margin - a)*inverse;
vec2 enter=min(low,high),leave=max(low,high);
t0=clamp(max(enter.x,enter.y),0.0,1.0);
t1=clamp(min(leave.x,leave.y),0.0,1.0);
return max(enter.x,enter.y)<=min(leave.x,leave.y)&&min(leave.x,leave.y)>=0.0&&max(enter.x,enter.y)<=1.0;
}
uint depth_key(float z){return uint(int(clamp(z,0.0,0.99999988)*2147483648.0))<<1u;}
const vec2 CELL_SHIFT=vec2(23.0,23.0)/256.0;
vec2 in_picture(vec4 window){
#if FEATURE_CLIPPING
return clamp(window.xy,vec2(0.0),viewport - 0.01);
#else
return window.xy;
#endif
}
vec2 pixel_of(vec4 window){return floor(in_picture(window));}
struct Cells{
ivec2 first;
vec2 run;
int count;
float shift;
float inverse;
float square;
};
Cells cells_between(ivec2 p,ivec2 q){
ivec2 run=q - p,size=abs(run);
int n=max(size.x,size.y);
bool steep=size.y>size.x;
float shift=steep?(run.y<0?-CELL_SHIFT.y:CELL_SHIFT.y):(run.x<0?-CELL_SHIFT.x:CELL_SHIFT.x);
vec2 way=vec2(run);
return Cells(p,way,n,shift,1.0/float(max(n,1)),1.0/max(dot(way,way),1.0));
}
#if FEATURE_CLIP_PLANES
layout(std140)uniform ClipPlanes{
vec4 clip_planes[8];
vec2 clip_tilts[8];
float clip_brushes[8];
int clip_plane_count;
float clip_rounding;
};
float clip_height_of(int plane,vec3 p){
precise float h=dot(clip_planes[plane].xyz,p)+ clip_planes[plane].w;
return h;
}
float clip_height(vec3 p){
float least=clip_height_of(0,p);
for(int plane=1;plane<clip_plane_count;++plane)least=min(least,clip_height_of(plane,p));
return least;
}
bool clip_touches(vec3 centre,float radius){
float margin=radius + 2.0*clip_rounding;
float w=window_from_local[0].w*centre.x + window_from_local[1].w*centre.y + window_from_local[2].w*centre.z;
w=max(w + window_from_local[3].w + radius*w_per_mm,0.0);
for(int plane=0;plane<clip_plane_count;++plane){
if(clip_height_of(plane,centre)<margin + w*clip_brushes[plane])return true;
}
return false;
}
bool clip_by_planes(vec3 a,vec3 b,inout float t0,inout float t1){
for(int plane=0;plane<clip_plane_count;++plane){
precise float ha=clip_height_of(plane,a),hb=clip_height_of(plane,b);
if(ha<0.0&&hb<0.0)return false;
precise float t=ha/(ha - hb);
if(ha<0.0)t0=max(t0,t);
else if(hb<0.0)t1=min(t1,t);
}
return t0<=t1;
}
bool on_kept_side(vec3 p){return clip_height(p)>=0.0;}
#else
bool clip_by_planes(vec3 a,vec3 b,inout float t0,inout float t1){return true;}
bool on_kept_side(vec3 p){return true;}
#endif
#if FEATURE_TUBES
#endif
struct Vertex{
vec3 local;
vec4 clip;
vec4 window;
bool inside;
};
struct ClippedSegment{
vec4 a;
vec4 b;
float t0;
float t1;
bool start;
bool cap;
float reach;
bool thin;
};
Vertex vertex_of(vec3 p){
precise vec4 clip=to_homogeneous(p);
precise vec4 window=to_window(clip);
bool inside=true;
#if FEATURE_CLIPPING_DEPTH
inside=in_volume(clip)&&on_kept_side(p);
#endif
return Vertex(p,clip,window,inside);
}
bool clip_in_space(Vertex from,Vertex to,inout ClippedSegment piece){
if(from.inside&&to.inside)return true;
float t0,t1;
if(!clip_segment(from.clip,to.clip,t0,t1))return false;
if(!clip_by_planes(from.local,to.local,t0,t1))return false;
if(t0>0.0)piece.a=to_window(from.clip + t0*(to.clip - from.clip));
if(t1<1.0)piece.b=to_window(from.clip + t1*(to.clip - from.clip));
piece=ClippedSegment(piece.a,piece.b,t0,t1,piece.start||t0>0.0,piece.cap||t1<1.0,0.0,false);
return true;
}
bool clip_in_window(Vertex from,Vertex to,inout ClippedSegment piece){
float t0,t1;
bool any_part=clip_window(from.window.xy,to.window.xy,t0,t1);
precise vec4 run=to.window - from.window,a=from.window + t0*run,b=t1<1.0?from.window + t1*run:to.window;
piece=ClippedSegment(a,b,t0,t1,piece.start||t0>0.0,piece.cap||t1<1.0,0.0,false);
return any_part;
}
bool piece_of(Vertex from,Vertex to,bool start,bool cap,out ClippedSegment piece){
piece=ClippedSegment(from.window,to.window,0.0,1.0,start,cap,0.0,false);
#if FEATURE_TUBES
Outline outline;
bool any_part=outline_of(from.clip,to.clip,outline);
piece=ClippedSegment(outline.a,outline.b,outline.t0,outline.t1,start,cap,outline.reach,outline.thin);
return any_part;
#elif FEATURE_CLIPPING_DEPTH
return clip_in_space(from,to,piece);
#elif FEATURE_CLIPPING
return clip_in_window(from,to,piece);
#else
return true;
#endif
}
bool piece_of(vec3 from,vec3 to,bool start,bool cap,out ClippedSegment piece){
return piece_of(vertex_of(from),vertex_of(to),start,cap,piece);
}
float corrected(float s,vec2 w){
return clamp(s*w.x/max((1.0 - s)*w.y + s*w.x,1e-30),0.0,1.0);
}
float along_segment(Vertex from,Vertex to,ClippedSegment piece,float s){
#if FEATURE_TUBES
return s;
#elif FEATURE_CLIPPING_DEPTH
return mix(piece.t0,piece.t1,corrected(s,vec2(piece.a.w,piece.b.w)));
#elif FEATURE_CLIPPING
return corrected(mix(piece.t0,piece.t1,s),vec2(from.window.w,to.window.w));
#else
return corrected(s,vec2(piece.a.w,piece.b.w));
#endif
}
const float JOINT_LEAST=0.1,JOINT_OVERLAP=0.05;
const uint NO_ONWARD=0x80008000u;
vec2 onward_at(vec4 end,vec3 ahead){
vec4 c=window_from_local[0]*ahead.x + window_from_local[1]*ahead.y + window_from_local[2]*ahead.z;
vec2 run=c.xy - end.xy*c.w;
float size=length(run);
return size>JOINT_LEAST*end.w?run/size:vec2(0.0);
}
bool beyond_joint(vec2 onward,vec2 away){return dot(onward,away)>JOINT_OVERLAP;}
uint packed_onward(vec2 onward){
if(onward==vec2(0.0))return NO_ONWARD;
ivec2 s=ivec2(round(32767.0*onward));
return uint(s.x&0xFFFF)|(uint(s.y)<<16u);
}
vec2 unpacked_onward(uint word){
return word==NO_ONWARD?vec2(0.0):vec2(ivec2(int(word<<16)>>16,int(word)>>16))/32767.0;
}
const uint FIBLET_MAX_POINTS=60u;
const uint FIBLET_PAGE_BITS=14u;
const uint FIBLET_CAPS=16u;
const float FIBLET_DIRECTION_SCALE=32767.0;
const float FIBLET_STEP_LEVELS=1023.0;
const uint FIBLET_WIDE_HEADER=20u;
const uint FIBLET_PLAIN_BYTES=12u;
const uint FIBLET_ANCHORS_WORDS=2u;
const uint FIBLET_DECODING_WORDS=3u;
const uint KIND_DIRECTION=0u;
const uint KIND_LATTICE8=1u;
const uint KIND_LATTICE16=2u;
const uint KIND_WIDE=3u;
uint fiblet_anchor_x(uvec2 words){return bitfieldExtract(words.x,0,16);}
uint fiblet_anchor_y(uvec2 words){return bitfieldExtract(words.x,16,16);}
uint fiblet_anchor_z(uvec2 words){return bitfieldExtract(words.y,0,16);}
uint fiblet_rank(uvec2 words){return bitfieldExtract(words.y,16,14);}
uint fiblet_begin(uvec2 words){return bitfieldExtract(words.y,30,1);}
uint fiblet_end(uvec2 words){return bitfieldExtract(words.y,31,1);}
uint fiblet_shape(uvec3 words){return bitfieldExtract(words.x,0,32);}
uint fiblet_code(uvec3 words){return bitfieldExtract(words.y,0,22);}
uint fiblet_step(uvec3 words){return bitfieldExtract(words.y,22,10);}
uint fiblet_point(uvec3 words){return bitfieldExtract(words.z,0,20);}
uint fiblet_last(uvec3 words){return bitfieldExtract(words.z,20,6);}
uint fiblet_cap(uvec3 words){return bitfieldExtract(words.z,26,4);}
uint fiblet_kind(uvec3 words){return bitfieldExtract(words.z,30,2);}
ivec3 fiblet_end_vector(uint word){return ivec3(bitfieldExtract(int(word),0,10),bitfieldExtract(int(word),10,10),bitfieldExtract(int(word),20,10));}
uint packed_direction(vec3 d){
float norm=abs(d.x)+ abs(d.y)+ abs(d.z);
vec2 s=d.yz/norm;
if(d.x<0.0)s=(1.0 - abs(s.yx))*vec2(s.x<0.0?-1.0:1.0,s.y<0.0?-1.0:1.0);
ivec2 i=ivec2(round(clamp(s,-1.0,1.0)*FIBLET_DIRECTION_SCALE));
return uint(i.x&0xFFFF)|(uint(i.y)<<16u);
}
uint packed_tangent(vec3 delta,uint before){
float size=max(abs(delta.x),max(abs(delta.y),abs(delta.z)));
return size>0.0?packed_direction(delta/size):before;
}
vec3 unit_or_none(vec3 d){
float size=max(abs(d.x),max(abs(d.y),abs(d.z)));
return size>0.0?normalize(d/size):vec3(0.0);
}
vec3 mean_direction(vec3 before,vec3 after){
vec3 sum=before + after;
float square=dot(sum,sum);
return square>1e-6?sum*inversesqrt(square):before;
}
struct Tangents{vec3 start;vec3 end;};
Tangents tangents_of(vec3 before,vec3 here,vec3 after,bool leads){
Tangents t=Tangents(mean_direction(before,here),vec3(0.0));
if(here!=vec3(0.0))before=here;
t.end=leads&&after!=vec3(0.0)?after:mean_direction(before,after);
if(t.start==vec3(0.0))t.start=t.end;
return t;
}
vec3 tangent_between(Tangents ends,float t){
vec3 d=mix(ends.start,ends.end,t);
return dot(d,d)>1e-6?d:ends.start;
}
uvec2 packed_tangents(Tangents ends){return uvec2(packed_tangent(ends.start,0u),packed_tangent(ends.end,0u));}
vec3 unpacked_tangent(uint word){
ivec2 s=ivec2(int(word<<16)>>16,int(word)>>16);
vec2 p=vec2(s)/FIBLET_DIRECTION_SCALE;
float x=1.0 - abs(p.x)- abs(p.y);
if(x<0.0)p=(1.0 - abs(p.yx))*vec2(s.x<0?-1.0:1.0,s.y<0?-1.0:1.0);
return normalize(vec3(x,p));
}
Tangents unpacked_tangents(uvec2 words){return Tangents(unpacked_tangent(words.x),unpacked_tangent(words.y));}
#ifndef VARYING
#define VARYING flat out
#endif
VARYING uvec4 seg_ids;
VARYING vec4 seg_start;
VARYING vec4 seg_end;
VARYING vec4 seg_along;
#if FEATURE_VALUES_COLOUR
VARYING uvec2 seg_colours;
#endif
#if FEATURE_WIDE_LINES
VARYING vec2 seg_onward;
#if FEATURE_CLIP_PLANES
VARYING vec3 seg_from;
VARYING vec3 seg_to;
#endif
#endif
const int ROW_BITS=12;
const bool SPRITES=false;
layout(location=0)in uvec4 slot_from;
layout(location=1)in uvec4 slot_to;
#if FEATURE_WIDE_LINES
layout(location=2)in uvec4 slot_after;
#endif
uniform int share_size;
uniform highp usampler2D items;
uniform int first_item;
uniform uint layer;
#if FEATURE_STREAMLINE_MASK
uniform highp usampler2D kept;
#endif
#if FEATURE_VALUES_COLOUR
uniform highp sampler2D point_colours;
vec4 colour_of(uint point){return texelFetch(point_colours,ivec2(int(point&4095u),int(point>>12u)),0);}
#endif
#if FEATURE_VALUES_STORED
uniform highp usampler2D value_texels;
uniform vec3 value_code;
float value_of(uint point){
uint code=texelFetch(value_texels,ivec2(int(point&4095u),int(point>>12u)),0).x;
return float(code)==value_code.z?uintBitsToFloat(0x7FC00000u):value_code.x + value_code.y*float(code);
}
#endif
void main(){
int index=SPRITES?gl_VertexID:gl_InstanceID,place=first_item + index/share_size;
uvec4 item=texelFetch(items,ivec2(place&((1<<ROW_BITS)- 1),place>>ROW_BITS),0);
uint points=item.z&63u,share=item.z>>8u;
bool begins=(item.z&64u)!=0u,ends=(item.z&128u)!=0u;
uint k=share*uint(share_size)+ uint(index%share_size),count=points -(ends&&points>1u?1u:0u);
gl_Position=vec4(2.0,2.0,2.0,1.0);
gl_PointSize=1.0;
if(k>=count)return;
#if FEATURE_STREAMLINE_MASK
if(texelFetch(kept,ivec2(int(item.x&4095u),int(item.x>>12u)),0).x==0u)return;
#endif
bool start=k==0u&&begins,cap=k + 1u==count&&ends;
vec2 values=vec2(0.0);
#if FEATURE_VALUES_STORED
values=vec2(value_of(item.y + k),value_of(item.y + min(k + 1u,points -(ends?1u:0u))));
#endif
vec3 from=uintBitsToFloat(slot_from.xyz),to=uintBitsToFloat(slot_to.xyz);
ClippedSegment piece;
if(!piece_of(from,to,start,cap,piece))return;
seg_ids=uvec4(item.x|layer,slot_from.w,slot_to.w,(piece.start?1u:0u)|(piece.cap?2u:0u));
seg_start=piece.a;
seg_end=piece.b;
seg_along=vec4(piece.t0,piece.t1,values);
#if FEATURE_VALUES_COLOUR
seg_colours=uvec2(packUnorm4x8(colour_of(item.y + k)),packUnorm4x8(colour_of(item.y + min(k + 1u,points -(ends?1u:0u)))));
#endif
#if FEATURE_WIDE_LINES
seg_onward=piece.cap?vec2(0.0):onward_at(piece.b,uintBitsToFloat(slot_after.xyz)- to);
#if FEATURE_CLIP_PLANES
seg_from=mix(from,to,piece.t0);
seg_to=mix(from,to,piece.t1);
#endif
vec2 a=piece.a.xy,run=piece.b.xy - a;
float size=length(run),reach=half_line_width + 0.05,back=piece.start?reach:0.05;
vec2 along=size>0.0?run/size:vec2(1.0,0.0),across=vec2(-along.y,along.x);
vec2 at=((gl_VertexID&2)==0?a - back*along:piece.b.xy + reach*along)+((gl_VertexID&1)==0?-reach:reach)*across;
gl_Position=vec4(2.0*at/viewport - 1.0,0.0,1.0);
#else
vec2 p=pixel_of(piece.a)+ 0.5 + CELL_SHIFT,q=pixel_of(piece.b)+ 0.5 + CELL_SHIFT,run=q - p;
float square=dot(run,run),size=sqrt(square);
vec2 along=size>0.0?run/size:vec2(1.0,0.0),across=vec2(-along.y,along.x);
if(size==0.0&&!piece.cap)return;
if(SPRITES){
vec2 size=abs(run)+ 1.0;
gl_PointSize=max(size.x,size.y);
gl_Position=vec4((p + q - 2.0*CELL_SHIFT)/viewport - 1.0,0.0,1.0);
return;
}
const float reach=0.75;
vec2 at=((gl_VertexID&2)==0?p - reach*along:q + reach*along)+((gl_VertexID&1)==0?-reach:reach)*across;
float depth=square>0.0?piece.a.z + dot(at - p,run)/square*(piece.b.z - piece.a.z):piece.b.z;
gl_Position=vec4(2.0*at/viewport - 1.0,2.0*clamp(depth,0.0,0.99999988)- 1.0,1.0);
#endif
}
`,"page/surface.frag":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
const int MOST_LIGHTS=8;
uniform int light_count;
uniform vec3 light_colour[MOST_LIGHTS];
uniform vec4 light_place[MOST_LIGHTS];
uniform vec3 light_sum;
uniform float light_standing;
vec3 to_light(int i,vec3 place){return normalize(light_place[i].xyz - light_place[i].w*place);}
float across_line(vec3 tangent,vec3 d){
float along=dot(tangent,d);
along*=along;
return max(0.0,1.0 - along*along);
}
vec3 light_on_line(vec3 own,vec3 tangent,vec3 place,bool illuminated,vec4 reflects,vec3 sheen){
vec3 sight=normalize(-place),normal=sight - tangent*dot(tangent,sight);
normal=length(normal)>1e-3?normalize(normal):sight;
vec3 diffuse=vec3(0.0),shine=vec3(0.0);
for(int i=0;i<light_count;++i){
vec3 l=to_light(i,place);
float along=dot(tangent,l),sine=sqrt(max(0.0,1.0 - along*along));
diffuse +=light_colour[i]*(illuminated?sine:across_line(tangent,l));
if(reflects.z>0.0){
float spread=illuminated?sine:sqrt(max(0.0,1.0 - along*along));
vec3 back=-along*tangent + spread*normal;
shine +=light_colour[i]*pow(max(1e-5,dot(back,sight)),reflects.w);
}
}
vec3 on;
if(illuminated)on=diffuse/max(1.0,max(light_sum.r,max(light_sum.g,light_sum.b)));
else{
float brightest=max(light_sum.r,max(light_sum.g,light_sum.b));
vec3 tint=light_sum/max(brightest,1e-6);
tint=mix(vec3(1.0),tint,1.0 - min(tint.r,min(tint.g,tint.b)));
vec3 share=min(diffuse/max(light_sum,vec3(1e-6)),vec3(1.0));
share=mix(vec3(across_line(tangent,vec3(-0.57735027,0.57735027,0.57735027))),share,light_standing);
on=min(brightest,1.0)*tint*mix(vec3(0.6),vec3(1.0),share);
}
return reflects.x*own + reflects.y*on*own + reflects.z*sheen*shine;
}
vec3 light_on_surface(vec3 own,vec3 normal,vec3 place,vec4 reflects,vec3 sheen){
vec3 diffuse=vec3(0.0),shine=vec3(0.0),sight=normalize(-place);
for(int i=0;i<light_count;++i){
vec3 l=to_light(i,place);
float facing=max(0.0,dot(normal,l));
diffuse +=facing*light_colour[i];
if(reflects.z>0.0&&facing>0.0)shine +=light_colour[i]*pow(max(0.0,dot(reflect(-l,normal),sight)),reflects.w);
}
return reflects.x*own + reflects.y*diffuse*own + reflects.z*sheen*shine;
}
uniform highp sampler2D table;
uniform vec4 table_range;
uniform int logarithm;
vec4 of_value(float value){
int n=int(table_range.w),entry;
if((floatBitsToUint(value)&0x7FFFFFFFu)>0x7F800000u)entry=n + 2;
else{
if(logarithm==1)value=value>0.0?log(value)*0.4342944819032518:-3.0e38;
if(value<table_range.x)entry=n;
else if(value>table_range.y)entry=n + 1;
else entry=int(min((value - table_range.x)*table_range.z,float(n - 1)));
}
return texelFetch(table,ivec2(entry&4095,entry>>12),0);
}
in vec3 view_place;
in vec3 view_normal;
in vec4 own_colour;
in vec3 data_place;
in float own_value;
uniform int smooth_normals;
uniform int lighting;
uniform int by_value;
uniform float parallel;
uniform float opacity;
uniform vec4 reflects;
uniform vec3 sheen;
uniform int plane_count;
uniform vec4 planes[6];
layout(location=0)out vec4 colour;
void main(){
for(int i=0;i<plane_count;++i)if(dot(planes[i].xyz,data_place)+ planes[i].w<0.0)discard;
vec3 normal=smooth_normals==1?normalize(view_normal):normalize(cross(dFdx(view_place),dFdy(view_place)));
vec3 sight=parallel==1.0?vec3(0.0,0.0,1.0):normalize(-view_place);
if(dot(normal,sight)<0.0)normal=-normal;
vec4 own=by_value==1?of_value(own_value):own_colour;
vec3 lit=lighting==1?light_on_surface(own.rgb,normal,view_place,reflects,sheen):own.rgb;
colour=vec4(lit,own.a*opacity);
}
`,"page/surface.vert":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
layout(location=0)in vec3 place;
layout(location=1)in vec3 normal;
layout(location=2)in vec4 own;
layout(location=3)in float value;
uniform mat4 clip_from_data;
uniform mat4 view_from_data;
uniform mat3 normal_to_view;
out vec3 view_place;
out vec3 view_normal;
out vec4 own_colour;
out vec3 data_place;
out float own_value;
void main(){
gl_Position=clip_from_data*vec4(place,1.0);
view_place=(view_from_data*vec4(place,1.0)).xyz;
view_normal=normal_to_view*normal;
own_colour=own;
data_place=place;
own_value=value;
}
`,"page/visible_edges.frag":`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
#define precise
uint bitfieldExtract(uint value,int offset,int bits){
return bits==32?value:(value>>uint(offset))&((1u<<uint(bits))- 1u);
}
int bitfieldExtract(int value,int offset,int bits){
return bits==32?value:(value<<(32 - offset - bits))>>(32 - bits);
}
int findMSB(uint value){
int at=value==0u?-1:0;
for(int width=16;width>0;width>>=1){
if((value>>uint(width))!=0u){value>>=uint(width);at +=width;}
}
return at;
}
int findMSB(int value){return findMSB(uint(value<0?~value:value));}
uint packUnorm4x8(vec4 value){
uvec4 bytes=uvec4(round(clamp(value,0.0,1.0)*255.0));
return bytes.x|bytes.y<<8u|bytes.z<<16u|bytes.w<<24u;
}
vec4 unpackUnorm4x8(uint word){return vec4(word&255u,word>>8u&255u,word>>16u&255u,word>>24u)/255.0;}
const uint FIBLET_MAX_POINTS=60u;
const uint FIBLET_PAGE_BITS=14u;
const uint FIBLET_CAPS=16u;
const float FIBLET_DIRECTION_SCALE=32767.0;
const float FIBLET_STEP_LEVELS=1023.0;
const uint FIBLET_WIDE_HEADER=20u;
const uint FIBLET_PLAIN_BYTES=12u;
const uint FIBLET_ANCHORS_WORDS=2u;
const uint FIBLET_DECODING_WORDS=3u;
const uint KIND_DIRECTION=0u;
const uint KIND_LATTICE8=1u;
const uint KIND_LATTICE16=2u;
const uint KIND_WIDE=3u;
uint fiblet_anchor_x(uvec2 words){return bitfieldExtract(words.x,0,16);}
uint fiblet_anchor_y(uvec2 words){return bitfieldExtract(words.x,16,16);}
uint fiblet_anchor_z(uvec2 words){return bitfieldExtract(words.y,0,16);}
uint fiblet_rank(uvec2 words){return bitfieldExtract(words.y,16,14);}
uint fiblet_begin(uvec2 words){return bitfieldExtract(words.y,30,1);}
uint fiblet_end(uvec2 words){return bitfieldExtract(words.y,31,1);}
uint fiblet_shape(uvec3 words){return bitfieldExtract(words.x,0,32);}
uint fiblet_code(uvec3 words){return bitfieldExtract(words.y,0,22);}
uint fiblet_step(uvec3 words){return bitfieldExtract(words.y,22,10);}
uint fiblet_point(uvec3 words){return bitfieldExtract(words.z,0,20);}
uint fiblet_last(uvec3 words){return bitfieldExtract(words.z,20,6);}
uint fiblet_cap(uvec3 words){return bitfieldExtract(words.z,26,4);}
uint fiblet_kind(uvec3 words){return bitfieldExtract(words.z,30,2);}
ivec3 fiblet_end_vector(uint word){return ivec3(bitfieldExtract(int(word),0,10),bitfieldExtract(int(word),10,10),bitfieldExtract(int(word),20,10));}
const float EDGE_STEPS=448.0;
const float EDGE_LEAST=2.0;
const float WIDTH_STEPS=32.0;
uint packed_edges(vec2 n,float e,float w,uint end){
vec2 q=n/max(abs(n.x)+ abs(n.y),1e-30);
int turn=int((q.y>=0.0?1.0 - q.x:3.0 + q.x)*512.0 + 0.5)&2047;
int inside=int(clamp((e + EDGE_LEAST)*EDGE_STEPS + 0.5,0.0,2047.0));
int across=int(clamp(w*WIDTH_STEPS + 0.5,1.0,127.0));
return uint(turn|(inside<<11)|(across<<22))|(end<<29u);
}
struct Edges{
vec2 n;
float e;
float w;
uint end;
float stop;
};
Edges unpacked_edges(uint word){
float turn=float(int(word&2047u))/512.0,x=abs(turn - 2.0)- 1.0;
int width=int((word>>22u)&127u),end=int(word>>29u);
return Edges(normalize(vec2(x,turn<2.0?1.0 - abs(x):abs(x)- 1.0)),
float(int((word>>11u)&2047u))/EDGE_STEPS - EDGE_LEAST,width==127?128.0:float(width)/WIDTH_STEPS,
uint(end),float(end>3?end - 5:end - 2)/3.0);
}
uniform highp usampler2D texels;
uniform highp sampler2D depths;
uniform highp sampler2D drawn;
uniform float narrower;
layout(location=0)out uvec4 shown;
uint thinned(uint word){
uint inside=(word>>11u)&2047u,width=(word>>22u)&127u;
inside -=min(inside,uint(0.5*narrower*EDGE_STEPS + 0.5));
width -=min(width - 1u,uint(narrower*WIDTH_STEPS + 0.5));
return(word&0xE00007FFu)|(inside<<11u)|(width<<22u);
}
void main(){
ivec2 pixel=ivec2(gl_FragCoord.xy)- 1;
shown=uvec4(0u);
if(any(lessThan(pixel,ivec2(0)))||any(greaterThanEqual(pixel,textureSize(texels,0))))return;
uvec4 texel=texelFetch(texels,pixel,0);
bool line=texel.x!=0xFFFFFFFFu||texel.y!=0xFFFFFFFFu;
shown=uvec4(floatBitsToUint(texelFetch(depths,pixel,0).r),line?thinned(texel.z):0u,packUnorm4x8(texelFetch(drawn,pixel,0)),0u);
}
`}};var ve=z.shaders,X=z.blocks,Te=z.rotation_scales,we=z.page_bits;function k(o){let e=atob(o),t=new Uint8Array(e.length);for(let n=0;n<e.length;++n)t[n]=e.charCodeAt(n);return t}var Ie=k(z.rotations),Ge=z.fields;function S(o,e){let[,t,n]=Ge[o];return n===32?e:e>>>t&(1<<n)-1}var J=(o,e)=>[o[0]-e[0],o[1]-e[1],o[2]-e[2]],P=(o,e,t=1)=>[o[0]+t*e[0],o[1]+t*e[1],o[2]+t*e[2]],M=(o,e)=>[o[0]*e,o[1]*e,o[2]*e],j=(o,e)=>o[0]*e[0]+o[1]*e[1]+o[2]*e[2],Y=(o,e)=>[o[1]*e[2]-o[2]*e[1],o[2]*e[0]-o[0]*e[2],o[0]*e[1]-o[1]*e[0]],Fe=o=>Math.hypot(o[0],o[1],o[2]),N=o=>M(o,1/(Fe(o)||1));function F(o,e){let t=new Float64Array(16);for(let n=0;n<4;++n)for(let i=0;i<4;++i){let r=0;for(let a=0;a<4;++a)r+=o[i+4*a]*e[a+4*n];t[i+4*n]=r}return t}function me(){let o=new Float64Array(16);return o[0]=o[5]=o[10]=o[15]=1,o}function Z(o){let e=Array.from({length:4},(n,i)=>Array.from({length:8},(r,a)=>a<4?o[i+4*a]:a-4===i?1:0));for(let n=0;n<4;++n){let i=n;for(let a=n+1;a<4;++a)Math.abs(e[a][n])>Math.abs(e[i][n])&&(i=a);if(!(Math.abs(e[i][n])>0))return null;[e[n],e[i]]=[e[i],e[n]];let r=e[n][n];for(let a=0;a<8;++a)e[n][a]/=r;for(let a=0;a<4;++a){if(a===n)continue;let s=e[a][n];for(let u=0;u<8;++u)e[a][u]-=s*e[n][u]}}let t=new Float64Array(16);for(let n=0;n<4;++n)for(let i=0;i<4;++i)t[n+4*i]=e[n][i+4];return t}function O(o,e,t=1){return[0,1,2,3].map(n=>o[n]*e[0]+o[n+4]*e[1]+o[n+8]*e[2]+o[n+12]*t)}function $(o){return[o[0],o[1],o[2],o[4],o[5],o[6],o[8],o[9],o[10]]}var se=o=>new Float32Array(o);function be(o,e,t){let n=t*Math.PI/180,i=Math.cos(n),r=Math.sin(n),a=N(e);return P(P(M(o,i),Y(a,o),r),a,j(a,o)*(1-i))}var oe=class{constructor(e){c(this,"state",e)}get forward(){return N(J(this.state.focal_point,this.state.position))}get right(){return N(Y(this.forward,this.state.up))}get distance(){return Fe(J(this.state.focal_point,this.state.position))}view(){let e=this.forward,t=this.right,n=Y(t,e),i=this.state.position;return new Float64Array([t[0],n[0],-e[0],0,t[1],n[1],-e[1],0,t[2],n[2],-e[2],0,-j(t,i),-j(n,i),j(e,i),1])}range(e){let t=this.forward,n=this.state.position,i=1/0,r=-1/0;for(let s=0;s<8;++s){let u=j(t,J([e[s&1],e[2+(s>>1&1)],e[4+(s>>2)]],n));i=Math.min(i,u),r=Math.max(r,u)}let a=Math.max(.005*(r-i),1e-6*Math.abs(r));return i-=a,r+=a,this.state.parallel?[i,Math.max(r,i+1e-6)]:(r=Math.max(r,1e-6),[Math.max(i,.001*r),r])}projection(e,t){let[n,i]=this.range(t),r=new Float64Array(16),a=this.state;if(a.parallel)r[0]=1/(a.parallel_scale*e),r[5]=1/a.parallel_scale,r[10]=-2/(i-n),r[14]=-(i+n)/(i-n),r[15]=1;else{let s=1/Math.tan(a.view_angle*Math.PI/360);r[0]=s/e,r[5]=s,r[10]=-(i+n)/(i-n),r[11]=-1,r[14]=-2*i*n/(i-n)}return r}rotate(e,t){let n=this.state,i=be(J(n.position,n.focal_point),n.up,-200*e),r=N(Y(M(i,-1),n.up));i=be(i,r,-200*t),n.position=P(n.focal_point,i),n.up=N(Y(r,N(M(i,-1))))}roll(e){this.state.up=be(this.state.up,this.forward,e)}pan(e,t){let n=this.state,i=n.parallel?2*n.parallel_scale:2*this.distance*Math.tan(n.view_angle*Math.PI/360),r=Y(this.right,this.forward),a=P(M(this.right,-e*i),r,-t*i);n.position=P(n.position,a),n.focal_point=P(n.focal_point,a)}dolly(e){let t=this.state;t.parallel?t.parallel_scale/=e:t.position=P(t.focal_point,J(t.position,t.focal_point),1/e)}lookAlong(e,t,n){let i=this.state,r=[(n[0]+n[1])/2,(n[2]+n[3])/2,(n[4]+n[5])/2],a=Math.hypot(n[1]-n[0],n[3]-n[2],n[5]-n[4])/2||1,s=a/Math.sin(i.view_angle*Math.PI/360);i.focal_point=r,i.position=P(r,N(e),-s),i.up=t,i.parallel_scale=a}};function g(o,e={},...t){let n=document.createElement(o);for(let[i,r]of Object.entries(e))n.setAttribute(i,r);return n.append(...t),n}var C=o=>Number.isFinite(o)?String(Number(o.toPrecision(4))):"no value";function D(o,e,t,n,i){let r=(t-e)/200||1,a=g("output",{},C(n)),s=g("input",{type:"range",min:String(e),max:String(t),step:String(r),value:String(n)});return s.addEventListener("input",()=>{a.textContent=C(s.valueAsNumber),i(s.valueAsNumber)}),g("label",{},g("span",{},o),s,a)}function ee(o,e){let t=g("button",{type:"button"},o);return t.addEventListener("click",e),t}function Q(o,...e){return g("fieldset",{},g("legend",{},o),...e)}var Ve=[["Left",[1,0,0],[0,0,1]],["Right",[-1,0,0],[0,0,1]],["Front",[0,-1,0],[0,0,1]],["Back",[0,1,0],[0,0,1]],["Top",[0,0,-1],[0,1,0]],["Bottom",[0,0,1],[0,1,0]]];function Ye(o){let e=k(o.table),t=e.length/4,n=g("canvas",{width:String(t),height:"1",role:"img","aria-label":`Colours from ${C(o.clim[0])} to ${C(o.clim[1])}`}),i=n.getContext("2d"),r=i.createImageData(t,1);r.data.set(e),i.putImageData(r,0,0);let[a,s]=o.clim,u=o.log?Math.sqrt(a*s):(a+s)/2;return g("figure",{class:"bar"},g("figcaption",{},o.title),n,g("div",{class:"ticks","aria-hidden":"true"},...[a,u,s].map(l=>g("span",{},C(l)))))}var _e=class{constructor(e,t){c(this,"lines",e);c(this,"base",t);c(this,"ranges",new Map);c(this,"regions",new Map)}set(e,t,n,i){let r=this.ranges.get(e.name)??{values:t,low:e.range[0],high:e.range[1],whole:e.range};n===0?r.low=i:r.high=i,this.ranges.set(e.name,r),this.apply()}apply(){let e=[...this.ranges.values()].filter(i=>i.low>i.whole[0]||i.high<i.whole[1]);if(!e.length&&!this.regions.size)return this.lines.keep(this.base);let t=this.lines.set.streamlines,n=new Uint8Array(t);for(let i=0;i<t;++i){let r=this.base===null||this.base[i]!==0;for(let a of e){let s=1e-6*(a.whole[1]-a.whole[0]);r=r&&a.values[i]>=a.low-s&&a.values[i]<=a.high+s}for(let a of this.regions.values())r=r&&a[i]!==0;n[i]=r?1:0}this.lines.keep(n)}},ue=class{constructor(e,t){c(this,"renderer",e);c(this,"data",t);c(this,"status",document.getElementById("status"));c(this,"axes",[]);c(this,"choices",new Map);c(this,"picked",null);c(this,"radius",5);let n=document.getElementById("over"),{scene:i}=e,r=g("details",{id:"panel"},g("summary",{},"Scene"));r.append(this.layers(),this.views(),this.cut(),...this.ranges(),this.region()),n.append(r),i.bars.length&&n.append(g("div",{id:"bars"},...i.bars.map(Ye))),n.append(this.orientation()),e.restored=()=>{for(let a of this.choices.values())a.apply()},e.presented=()=>this.turnAxes(),this.turnAxes()}layers(){let{renderer:e}=this,t=[];return e.scene.layers.forEach(n=>{let i=g("input",{type:"checkbox"});i.checked=n.visible,i.addEventListener("change",()=>{n.visible=i.checked,e.change()}),t.push(g("label",{},i,g("span",{},n.name))),n.kind==="fiblets"?t.push(D("Line width",.5,10,n.line_width,r=>{n.line_width=r,e.change(!0)})):t.push(D("Opacity",0,1,n.opacity,r=>{n.opacity=r,e.change(!0)}))}),Q("Shown",...t)}views(){let{renderer:e}=this,t=structuredClone(e.camera.state),n=Ve.map(([i,r,a])=>ee(i,()=>{e.camera.lookAlong(r,a,e.scene.bounds),e.change()}));return n.push(ee("As at first",()=>{Object.assign(e.camera.state,structuredClone(t)),e.change()})),n.push(ee("Save picture",()=>this.save())),Q("View",g("div",{class:"buttons"},...n))}save(){let{renderer:e}=this;e.settled().then(()=>{let t=g("canvas",{width:String(e.width),height:String(e.height)}),n=t.getContext("2d"),i=n.createImageData(e.width,e.height);i.data.set(e.pixels()),n.putImageData(i,0,0),t.toBlob(r=>{let a=g("a",{href:URL.createObjectURL(r),download:"picture.png"});a.click(),setTimeout(()=>URL.revokeObjectURL(a.href),6e4)})})}cut(){let{renderer:e}=this,t=e.scene.bounds,n=g("select",{"aria-label":"Cut across"});for(let u of["nothing","left to right","back to front","bottom to top"])n.append(g("option",{},u));let i=g("div"),r=0,a=0,s=()=>{let u=n.selectedIndex-1,l=d=>[0,1,2].map(f=>f===u?d:0).concat(-d*r+a/2);e.planes=u<0?[]:[l(1),l(-1)],e.change(!0)};return n.addEventListener("change",()=>{let u=n.selectedIndex-1;if(i.replaceChildren(),u>=0){let l=t[2*u],d=t[2*u+1];r=(l+d)/2,a=(d-l)/8,i.append(D("Middle",l,d,r,f=>{r=f,s()}),D("Thickness",(d-l)/200,d-l,a,f=>{a=f,s()}))}s()}),Q("Slab across",n,i)}choiceOf(e){let t=this.choices.get(e.index);return t||this.choices.set(e.index,t=new _e(e,e.layer.kept===void 0?null:this.data[e.layer.kept])),t}ranges(){let{renderer:e}=this,t=[];for(let n of e.lines){let{values:i,layer:r}=n;if(i){let a=i.code[0],s=a+i.code[1]*(i.code[2]-1),u=[a,s],l=()=>{e.lines[n.index].shownValues=u[0]>a||u[1]<s?[u[0],u[1]]:[1,0],e.change(!0)};t.push(Q(i.name,D("From",a,s,a,d=>{u[0]=d,l()}),D("To",a,s,s,d=>{u[1]=d,l()})))}for(let a of r.controls??[]){if(a.data===void 0)continue;let s=this.data[a.data],u=new Float32Array(s.slice().buffer),[l,d]=a.range,f=v=>p=>{this.choiceOf(e.lines[n.index]).set(a,u,v,p),e.change(!0)};t.push(Q(a.name,D("From",l,d,l,f(0)),D("To",l,d,d,f(1))))}}return t}region(){let{renderer:e}=this,t=e.scene.bounds,n=Math.hypot(t[1]-t[0],t[3]-t[2],t[5]-t[4]);this.radius=n/40;let i=()=>{if(!this.picked){this.status.textContent="Click on a streamline first.";return}let{lines:a,place:s}=this.picked,u=a.set.through(s,this.radius),l=this.choiceOf(a);l.regions.set("ball",u),l.apply(),e.change(),this.status.textContent=`${u.reduce((d,f)=>d+f,0)} streamlines pass within ${C(this.radius)} mm of the place`},r=()=>{for(let a of this.choices.values())a.regions.clear(),a.apply();e.change(),this.status.textContent=""};return Q("Region",D("Radius, mm",n/1e3,n/5,this.radius,a=>{this.radius=a}),g("div",{class:"buttons"},ee("Those through the picked place",i),ee("All",r)))}pick(e,t){let{renderer:n}=this,i=n.pick(e,t);for(let r of n.lines)r.marked=4294967295;if(this.picked=null,i){let{lines:r,streamline:a,value:s}=i,u=n.placeOf(r,a,e,t);r.marked=a,this.picked={lines:r,streamline:a,place:u};let l=[`Streamline ${a} of ${r.layer.name}`];s!==null&&r.values&&l.push(`${r.values.name} ${C(s)}`);for(let f of r.layer.controls??[])f.data!==void 0&&l.push(`${f.name} ${C(new Float32Array(this.data[f.data].slice().buffer)[a])}`);let d=O(r.model,u);l.push(`at ${d.slice(0,3).map(C).join(", ")} mm`),this.status.textContent=l.join("; ")}else this.status.textContent="";n.change()}orientation(){let t=(this.renderer.scene.letters?[["L","R"],["P","A"],["I","S"]]:[["","x"],["","y"],["","z"]]).flat().map((n,i)=>g("span",{class:`axis a${i>>1}`},n));return this.axes=t,g("div",{id:"axes","aria-hidden":"true"},...t)}turnAxes(){let e=this.renderer.camera.view();this.axes.forEach((t,n)=>{let i=M([0,1,2].map(u=>u===n>>1?1:0),n&1?1:-1),[r,a,s]=O(e,i,0);t.style.transform=`translate(${(r*32).toFixed(1)}px, ${(-a*32).toFixed(1)}px)`,t.style.opacity=String(.35+.65*(.5+s/2))})}};function Re(o,e=()=>{}){let{canvas:t,camera:n}=o,i=new Map,r=0,a=0;t.addEventListener("pointerdown",u=>{t.focus(),t.setPointerCapture(u.pointerId),i.set(u.pointerId,{x:u.offsetX,y:u.offsetY}),r=0,a=u.button,u.preventDefault()}),t.addEventListener("contextmenu",u=>u.preventDefault());let s=u=>{i.delete(u.pointerId)&&(u.type==="pointerup"&&r<4&&a===0&&!i.size?e(u.offsetX,u.offsetY):o.change())};t.addEventListener("pointerup",s),t.addEventListener("pointercancel",s),t.addEventListener("pointermove",u=>{let l=i.get(u.pointerId);if(!l)return;let d=u.offsetX-l.x,f=u.offsetY-l.y,v=t.clientWidth,p=t.clientHeight;if(r+=Math.abs(d)+Math.abs(f),i.size===2){let w=[...i.entries()].find(([T])=>T!==u.pointerId)[1],b=[l.x-w.x,l.y-w.y],_=[u.offsetX-w.x,u.offsetY-w.y];n.dolly(Math.hypot(_[0],_[1])/Math.max(1,Math.hypot(b[0],b[1]))),n.roll((Math.atan2(_[1],_[0])-Math.atan2(b[1],b[0]))*180/Math.PI),n.pan(d/2/p,-f/2/p)}else a===1||u.shiftKey?n.pan(d/p,-f/p):a===2?n.dolly(Math.pow(1.1,-20*.2*f/(p/2)*5)):u.ctrlKey?n.roll(180*d/v):n.rotate(d/v,-f/p);l.x=u.offsetX,l.y=u.offsetY,o.change(!0)}),t.addEventListener("wheel",u=>{n.dolly(Math.pow(1.1,Math.max(-3,Math.min(3,-u.deltaY/50)))),o.change(!0),u.preventDefault()},{passive:!1}),t.addEventListener("keydown",u=>{let d={ArrowLeft:()=>u.shiftKey?n.pan(-.04,0):n.rotate(-.04,0),ArrowRight:()=>u.shiftKey?n.pan(.04,0):n.rotate(.04,0),ArrowUp:()=>u.shiftKey?n.pan(0,.04):n.rotate(0,.04),ArrowDown:()=>u.shiftKey?n.pan(0,-.04):n.rotate(0,-.04),"+":()=>n.dolly(1.1),"=":()=>n.dolly(1.1),"-":()=>n.dolly(.9090909090909091),Enter:()=>e(t.clientWidth/2,t.clientHeight/2)};u.altKey||u.metaKey||!d[u.key]||(d[u.key](),o.change(!0),u.preventDefault())})}var y=class extends Error{},Qe=101010256,qe=101075792,He=117853008,We=33639248,Ke=67324752,Xe="header.json";function q(o,e){return o.getUint32(e,!0)+o.getUint32(e+4,!0)*4294967296}function Je(o){let e=o.byteLength;for(let t=e-22;t>=Math.max(0,e-65558);--t)if(o.getUint32(t,!0)===Qe){if(t>=20&&o.getUint32(t-20,!0)===He){let n=q(o,t-12);if(n+56<=e&&o.getUint32(n,!0)===qe)return[q(o,n+48),q(o,n+32)]}return[o.getUint32(t+16,!0),o.getUint16(t+10,!0)]}throw new y("This is no whole .fiblets file: the end of its zip archive is missing. Copy or make it again.")}function je(o,e,t,n){let i=o.getUint32(e+24,!0),r=o.getUint32(e+42,!0),a=o.getUint32(e+20,!0);for(let s=e+46+t,u=s+n;s+4<=u;){let l=o.getUint16(s,!0),d=o.getUint16(s+2,!0),f=s+4;l===1&&(i===4294967295&&(i=q(o,f),f+=8),a===4294967295&&(a=q(o,f),f+=8),r===4294967295&&(r=q(o,f))),s+=4+d}return[i,r]}var Ze={"|u1":[1,Uint8Array],"|i1":[1,Int8Array],"|b1":[1,Uint8Array],"<u2":[2,Uint16Array],"<i2":[2,Int16Array],"<u4":[4,Uint32Array],"<i4":[4,Int32Array],"<f4":[4,Float32Array],"<f8":[8,Float64Array],"<i8":[8,BigInt64Array],"<u8":[8,BigUint64Array]};function $e(o,e){let t=new y(`The member ${e} of the file is damaged. Copy or make the file again.`);if(o.length<10||o[0]!==147||o[6]!==1)throw t;let n=o[8]|o[9]<<8,i=new TextDecoder("latin1").decode(o.subarray(10,10+n)),r=/'descr':\s*'([^']+)'/.exec(i),a=/'shape':\s*\(([^)]*)\)/.exec(i);if(!r||!a||/'fortran_order':\s*True/.test(i))throw t;let s=Ze[r[1]];if(!s)return null;let u=a[1].split(",").map(p=>p.trim()).filter(p=>p).map(Number),l=u.reduce((p,w)=>p*w,1),d=o.byteOffset+10+n;if(!u.every(p=>Number.isSafeInteger(p)&&p>=0)||10+n+l*s[0]>o.length)throw t;let f=o.buffer,v=d%s[0]===0?new s[1](f,d,l):new s[1](f.slice(d,d+l*s[0]),0,l);return{shape:u,data:v}}function Be(o){let e=new DataView(o.buffer,o.byteOffset,o.byteLength);if(o.length<22)throw new y("This is no .fiblets file: it is empty, or cut short.");let[t,n]=Je(e),i=new Map,r=null,a=t;for(let s=0;s<n;++s){if(a+46>o.length||e.getUint32(a,!0)!==We)throw new y("The list of the file's members is damaged. Copy or make the file again.");let u=e.getUint16(a+28,!0),l=e.getUint16(a+30,!0),d=e.getUint16(a+32,!0),f=new TextDecoder().decode(o.subarray(a+46,a+46+u)),[v,p]=je(e,a,u,l);if(e.getUint16(a+10,!0)!==0)throw new y(`The member ${f} of the file is compressed; .fiblets files store their members as they are.`);if(p+30>o.length||e.getUint32(p,!0)!==Ke)throw new y(`The member ${f} of the file is damaged. Copy or make the file again.`);let w=p+30+e.getUint16(p+26,!0)+e.getUint16(p+28,!0);if(w+v>o.length)throw new y(`The file ends within its member ${f}. Copy or make it again.`);let b=o.subarray(w,w+v);if(f===Xe)try{r=JSON.parse(new TextDecoder().decode(b))}catch{throw new y("The file's header is damaged. Copy or make the file again.")}else{let _=$e(b,f);_&&i.set(f,_)}a+=46+u+l+d}if(r===null||typeof r!="object")throw new y("This is a zip archive, but no .fiblets file: it has no header.json.");return{header:r,arrays:i}}var G=4096,H=class extends Error{};function en(o,e){return(e.includes("SPRITES")?ve[o].replace("const bool SPRITES=false","const bool SPRITES=true"):ve[o]).replace(/#define FEATURE_(\w+) [01]/g,(n,i)=>`#define FEATURE_${i} ${e.includes(i)?1:0}`)}var W=class{constructor(e,t,n,i=[],r=[]){c(this,"gl",e);c(this,"handle");c(this,"places",new Map);c(this,"units",new Map);this.handle=e.createProgram();let a=[[e.VERTEX_SHADER,t],[e.FRAGMENT_SHADER,n]].map(([s,u])=>{let l=e.createShader(s);return e.shaderSource(l,en(u,i)),e.compileShader(l),e.attachShader(this.handle,l),[u,l]});if(r.length&&e.transformFeedbackVaryings(this.handle,r,e.INTERLEAVED_ATTRIBS),e.linkProgram(this.handle),!e.getProgramParameter(this.handle,e.LINK_STATUS)&&!e.isContextLost()){let s=a.map(([u,l])=>`${u}: ${e.getShaderInfoLog(l)}`).join("; ");throw new H(`This browser's graphics cannot run the page's programs: ${e.getProgramInfoLog(this.handle)} ${s}`)}Object.keys(X).forEach((s,u)=>{let l=e.getUniformBlockIndex(this.handle,s);l!==e.INVALID_INDEX&&e.uniformBlockBinding(this.handle,l,u)})}use(){return this.gl.useProgram(this.handle),this}at(e){return this.places.has(e)||this.places.set(e,this.gl.getUniformLocation(this.handle,e)),this.places.get(e)}set(e){let t=this.gl;for(let[n,i]of Object.entries(e)){let r=this.at(n);r!==null&&(typeof i=="number"?t.uniform1f(r,i):i.length===2?t.uniform2fv(r,i):i.length===3?t.uniform3fv(r,i):i.length===4?t.uniform4fv(r,i):i.length===9?t.uniformMatrix3fv(r,!1,i):t.uniformMatrix4fv(r,!1,i))}return this}ints(e){for(let[t,n]of Object.entries(e)){let i=this.at(t);i!==null&&this.gl.uniform1i(i,n)}return this}uints(e){for(let[t,n]of Object.entries(e)){let i=this.at(t);i!==null&&this.gl.uniform1ui(i,n)}return this}textures(e){let t=this.gl;for(let[n,i]of Object.entries(e)){let r=this.at(n);if(r===null)continue;this.units.has(n)||this.units.set(n,this.units.size);let a=this.units.get(n);t.activeTexture(t.TEXTURE0+a),t.bindTexture(t.TEXTURE_2D,i),t.uniform1i(r,a)}return this}},nn={r8ui:["R8UI","RED_INTEGER","UNSIGNED_BYTE",1,Uint8Array],r16ui:["R16UI","RED_INTEGER","UNSIGNED_SHORT",1,Uint16Array],r32ui:["R32UI","RED_INTEGER","UNSIGNED_INT",1,Uint32Array],rg32ui:["RG32UI","RG_INTEGER","UNSIGNED_INT",2,Uint32Array],rgba32ui:["RGBA32UI","RGBA_INTEGER","UNSIGNED_INT",4,Uint32Array],rgba8:["RGBA8","RGBA","UNSIGNED_BYTE",4,Uint8Array]};function Le(o){for(let e of["TEXTURE_MIN_FILTER","TEXTURE_MAG_FILTER"])o.texParameteri(o.TEXTURE_2D,o[e],o.NEAREST);for(let e of["TEXTURE_WRAP_S","TEXTURE_WRAP_T"])o.texParameteri(o.TEXTURE_2D,o[e],o.CLAMP_TO_EDGE)}function B(o,e,t,n){let[i,r,a,s,u]=nn[e],l=Math.ceil(t.length/s),d=Math.max(1,Math.ceil(l/G));if(d>o.getParameter(o.MAX_TEXTURE_SIZE))throw new H(`The ${n} have ${l} texels; this device's textures hold ${o.getParameter(o.MAX_TEXTURE_SIZE)*G}. Make a page of fewer streamlines.`);let f=o.createTexture();o.bindTexture(o.TEXTURE_2D,f),Le(o),o.pixelStorei(o.UNPACK_ALIGNMENT,1),o.texStorage2D(o.TEXTURE_2D,1,o[i],G,d);let v=Math.floor(l/G),p=G*s;for(let w=0;w<v;w+=256){let b=Math.min(256,v-w);o.texSubImage2D(o.TEXTURE_2D,0,0,w,G,b,o[r],o[a],t.subarray(w*p,(w+b)*p))}if(v<d){let w=new u(p);w.set(t.subarray(v*p)),o.texSubImage2D(o.TEXTURE_2D,0,0,v,G,1,o[r],o[a],w)}return f}function le(o,e,t,n){let i=e.length/4-3,[r,a]=n?t.map(s=>Math.log10(s)):t;return[B(o,"rgba8",e,"colours"),[r,a,i/Math.max(a-r,1e-30),i]]}function ne(o,e,t,n){let i=o.createTexture();return o.bindTexture(o.TEXTURE_2D,i),Le(o),o.texStorage2D(o.TEXTURE_2D,1,e,t,n),i}function te(o,e,t){let n=o.createFramebuffer();return o.bindFramebuffer(o.FRAMEBUFFER,n),o.framebufferTexture2D(o.FRAMEBUFFER,o.COLOR_ATTACHMENT0,o.TEXTURE_2D,e,0),t&&o.framebufferTexture2D(o.FRAMEBUFFER,o.DEPTH_ATTACHMENT,o.TEXTURE_2D,t,0),n}var U=class{constructor(e,t){c(this,"gl",e);c(this,"name",t);c(this,"bytes");c(this,"floats");c(this,"words");c(this,"buffer");c(this,"binding");this.bytes=new ArrayBuffer(X[t].bytes),this.floats=new Float32Array(this.bytes),this.words=new Uint32Array(this.bytes),this.buffer=e.createBuffer(),this.binding=Object.keys(X).indexOf(t),e.bindBuffer(e.UNIFORM_BUFFER,this.buffer),e.bufferData(e.UNIFORM_BUFFER,this.bytes.byteLength,e.DYNAMIC_DRAW)}write(e,t=[]){for(let[n,i]of Object.entries(e)){let r=X[this.name].fields[n]/4,a=t.includes(n)?this.words:this.floats;typeof i=="number"?a[r]=i:a.set(i,r)}this.upload()}fill(e){new Uint8Array(this.bytes).set(e),this.upload()}upload(){this.gl.bindBuffer(this.gl.UNIFORM_BUFFER,this.buffer),this.gl.bufferSubData(this.gl.UNIFORM_BUFFER,0,new Uint8Array(this.bytes))}bind(){this.gl.bindBufferBase(this.gl.UNIFORM_BUFFER,this.binding,this.buffer)}};var tn=1024,ie=16,rn=[4,8,11,15],Se=0,an=3;function ke(o,e,t,n){if(!o||!(o.data instanceof Uint32Array)||o.data.length!==t*n)throw new y(`The file's ${e} do not fit its header. Copy or make it again.`);return o.data}var ce=class{constructor(e,t){c(this,"gl",e);c(this,"archive",t);c(this,"blocks",[]);c(this,"streamlines");c(this,"points");c(this,"bounds");c(this,"reference");c(this,"toData");c(this,"coding");c(this,"items");c(this,"budget",256<<20);c(this,"parameters");c(this,"decodeProgram");c(this,"rotationBlock");c(this,"frameForDecoding");c(this,"textures",{});c(this,"itemBuffer");c(this,"toItems");c(this,"feedback");c(this,"scratch",null);c(this,"scratchBytes",0);c(this,"share",15);c(this,"itemBytes",15*ie);c(this,"kinds");c(this,"held",0);c(this,"clock",0);c(this,"fiblets");c(this,"decodeArray");c(this,"arrays",[null,null]);let{header:n,arrays:i}=t;if(n.format!=="fiblets")throw new y("The file is no .fiblets file: its header says something else.");if(n.version!==2)throw new y(`The file is of version ${n.version}; this page reads version 2. Make the page again with a newer pvfiblets.`);let r=this.parameters=n.parameters,a=this.fiblets=n.n_fiblets;this.streamlines=n.n_streamlines,this.points=n.n_points,this.bounds=n.bounds;let s=ke(i.get("anchors.npy"),"anchors",2,a),u=ke(i.get("decoding.npy"),"records",3,a),l=i.get("codes.npy"),d=i.get("pages.npy");if(!l||!(l.data instanceof Uint8Array)||!d||!(d.data instanceof BigInt64Array))throw new y("The file's codes or pages are missing. Copy or make it again.");let f=Array.from(d.data,Number),v=Math.ceil(a/(1<<we));if(f.length!==3*(v+1)||f[3*v+1]!==l.data.length||f[3*v+2]!==this.points)throw new y("The file's table of pages does not fit its records. Copy or make it again.");let p=r.anchor_bits===32?i.get("anchors_low.npy"):void 0;if(r.anchor_bits===32&&!(p?.data instanceof Uint16Array&&p.data.length===3*a))throw new y("The lower halves of the file's anchors are missing. Copy or make it again.");let w=r.anchor_bits===32?4294967295:65535;this.reference=[0,1,2].map(m=>{let h=(this.bounds[2*m]+this.bounds[2*m+1])/2,x=r.anchor_scale[m];return x>0&&Number.isFinite(h)?Math.round(Math.min(Math.max((h-r.origin[m])/x,0),w)):0}),this.toData=new Float64Array([1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]);for(let m=0;m<3;++m)this.toData[12+m]=r.origin[m]+r.anchor_scale[m]*this.reference[m];let b=this.kinds=this.makeItems(s,u,f,l.data.length,p?.data);this.items=this.textures.items,this.textures.anchor_texels=B(e,"rg32ui",s,"anchors"),this.textures.decoding_texels=B(e,"r32ui",u,"records");let _=l.data.byteOffset%4===0?l.data:l.data.slice(),T=_.length>>2,E=new Uint32Array(_.buffer,_.byteOffset,T);this.textures.code_texels=this.codeTexture(E,_.subarray(4*T));let A=new Uint32Array(4*Math.max(v,1));for(let m=0;m<v;++m)for(let h=0;h<3;++h)A[4*m+h]=f[3*m+h];this.textures.page_texels=B(e,"rgba32ui",A,"pages");let R=["DIRECTION"];if(p){R.push("ANCHORS_LOW");let m=p.data,h=new Uint32Array(m.length+1>>1);for(let x=0;x<m.length;++x)h[x>>1]|=m[x]<<16*(x&1);this.textures.anchor_low_texels=B(e,"r32ui",h,"anchors")}(b.size>1||!b.has(Se))&&R.push("LATTICE"),b.has(an)&&R.push("WIDE_LATTICE"),this.coding=new U(e,"Coding"),this.coding.write({anchor_scale:r.anchor_scale,radius_scale:0,step_low:r.step_lo,step_span:r.step_hi-r.step_lo,lattice_edge:r.lattice,end_vector_scale:0,rotation_scales:Te}),this.rotationBlock=new U(e,"Rotations"),this.rotationBlock.fill(Ie),this.frameForDecoding=new U(e,"Frame"),this.frameForDecoding.write({reference:this.reference},["reference"]),this.decodeProgram=new W(e,"page/decode.vert","page/none.frag",R,Array.from({length:this.share},(m,h)=>`o${h}`)),this.feedback=e.createTransformFeedback(),this.decodeArray=e.createVertexArray(),e.bindVertexArray(this.decodeArray),e.enableVertexAttribArray(0),e.bindVertexArray(null)}codeTexture(e,t){if(!t.length)return B(this.gl,"r32ui",e,"codes");let n=new Uint32Array(e.length+1);n.set(e);for(let i=0;i<t.length;++i)n[e.length]|=t[i]<<8*i;return B(this.gl,"r32ui",n,"codes")}makeItems(e,t,n,i,r){let a=this.gl,s=this.fiblets,u=this.parameters,l=this.archive.arrays.get("rank_to_id.npy")?.data,d=new Uint8Array(s),f=new Float64Array(128);for(let h=0;h<s;++h)++f[S("last",t[3*h+2])+1+(e[2*h+1]>>>31)*64];let v=(h,x,L)=>h%L===0&&!x?h/L:Math.ceil((h+(x?1:2))/L),p=h=>f.reduce((x,L,V)=>{let K=v(V&63,V>>6,h);return x+L*K*h*(1+.05*K)},0);this.share=rn.reduce((h,x)=>p(x)<p(h)?x:h),this.itemBytes=this.share*ie;let w=0;for(let h=0;h<s;++h)d[h]=v(S("last",t[3*h+2])+1,e[2*h+1]>>>31,this.share),w+=d[h];let b=new Uint32Array(4*Math.max(w,1)),_=new Uint32Array(2*Math.max(w,1)),T=new Set,E=2*u.largest_radius,A=0,R=0,m=null;for(let h=0;h<s;++h){let x=3*(h>>we),L=e[2*h+1],V=t[3*h+2],K=S("rank",L)+n[x],ae=S("last",V)+1,pe=l?Number(l[K]):K,Ee=S("begin",L),Pe=S("end",L),Oe=S("code",t[3*h+1])+n[x+1],xe=S("point",V)+n[x+2];if(ae>60||!(pe>=0&&pe<this.streamlines)||Oe>i||xe+ae>this.points)throw new y(`Record ${h} of the file is damaged. Copy or make it again.`);T.add(S("kind",V)),h%tn===0&&this.blocks.push(m={firstItem:A,items:0,more:0,bounds:[1/0,-1/0,1/0,-1/0,1/0,-1/0],buffer:null,used:0});let ye=[e[2*h]&65535,e[2*h]>>>16,L&65535];for(let I=0;I<3;++I){let Ae=u.origin[I]+u.anchor_scale[I]*(r?ye[I]*65536+r[3*h+I]:ye[I]);m.bounds[2*I]=Math.min(m.bounds[2*I],Ae-E),m.bounds[2*I+1]=Math.max(m.bounds[2*I+1],Ae+E)}Ee&&(R=0);for(let I=0;I<d[h];++I,++A)b[4*A]=pe,b[4*A+1]=xe,b[4*A+2]=ae|Ee<<6|Pe<<7|I<<8,b[4*A+3]=R,_[2*A]=h,_[2*A+1]=I;R+=ae,m.items+=d[h]}for(let h of this.blocks)h.more=h.firstItem+h.items<w?1:0;return this.toItems=b,this.textures.items=B(a,"rgba32ui",b,"shares of fiblets"),this.itemBuffer=a.createBuffer(),a.bindBuffer(a.ARRAY_BUFFER,this.itemBuffer),a.bufferData(a.ARRAY_BUFFER,_,a.STATIC_DRAW),T}pointValues(e){let t=this.archive.header.per_point?.[e],n=t&&this.archive.arrays.get(t.member);if(!n||n.data.length!==this.points)throw new y(`The file has no values ${e} for its points.`);let i=n.data instanceof Uint16Array,r=i?65535:255;return{name:e,texture:B(this.gl,i?"r16ui":"r8ui",n.data,"values of points"),code:[t.lo,(t.hi-t.lo)/(r-1),r]}}decode(e,t){let n=this.gl,i=e.items+e.more;this.coding.bind(),this.rotationBlock.bind(),this.frameForDecoding.bind();let{items:r,...a}=this.textures;this.decodeProgram.use().textures(a).uints({chunk_fiblets:this.fiblets,share_size:this.share}),n.bindVertexArray(this.decodeArray),n.bindBuffer(n.ARRAY_BUFFER,this.itemBuffer),n.vertexAttribIPointer(0,2,n.UNSIGNED_INT,8,8*e.firstItem),n.bindBuffer(n.ARRAY_BUFFER,null),n.enable(n.RASTERIZER_DISCARD),n.bindTransformFeedback(n.TRANSFORM_FEEDBACK,this.feedback),n.bindBufferRange(n.TRANSFORM_FEEDBACK_BUFFER,0,t,0,i*this.itemBytes),n.beginTransformFeedback(n.POINTS),n.drawArrays(n.POINTS,0,i),n.endTransformFeedback(),n.bindBufferBase(n.TRANSFORM_FEEDBACK_BUFFER,0,null),n.bindTransformFeedback(n.TRANSFORM_FEEDBACK,null),n.disable(n.RASTERIZER_DISCARD),n.bindVertexArray(null)}size(e){return(e.items+e.more)*this.itemBytes+2*ie}newBuffer(e){let t=this.gl,n=t.createBuffer();return t.bindBuffer(t.ARRAY_BUFFER,n),t.bufferData(t.ARRAY_BUFFER,e,t.DYNAMIC_COPY),t.bindBuffer(t.ARRAY_BUFFER,null),n}pointsOf(e){if(e.used=++this.clock,e.buffer)return e.buffer;let t=this.size(e);return this.held+t<=this.budget?(this.held+=t,e.buffer=this.newBuffer(t),this.decode(e,e.buffer),e.buffer):(this.scratchBytes<t&&(this.scratch&&this.gl.deleteBuffer(this.scratch),this.scratch=this.newBuffer(this.scratchBytes=t)),this.decode(e,this.scratch),this.scratch)}instances(e){return e.items*this.share}get longestStep(){return this.kinds.size===1&&this.kinds.has(Se)?2*this.parameters.step_hi:1/0}draw(e,t,n,i){let r=this.gl,a=this.pointsOf(e);t.use().ints({first_item:e.firstItem,share_size:this.share}),r.bindVertexArray(this.segmentArray(i)),r.bindBuffer(r.ARRAY_BUFFER,a);for(let u=0;u<3;++u)r.vertexAttribIPointer(u,4,r.UNSIGNED_INT,ie,u*ie);let s=Math.max(1,Math.round(e.items*n))*this.share;return i?r.drawArrays(r.POINTS,0,s):r.drawArraysInstanced(r.TRIANGLE_STRIP,0,4,s),r.bindVertexArray(null),s}segmentArray(e){let t=e?1:0;if(!this.arrays[t]){let n=this.gl;n.bindVertexArray(this.arrays[t]=n.createVertexArray());for(let i=0;i<3;++i)n.enableVertexAttribArray(i),n.vertexAttribDivisor(i,e?0:1)}return this.arrays[t]}*decoded(e){let t=this.gl,n=this.toItems;for(let i of this.blocks){if(!e(i))continue;let r=new Float32Array((i.items+i.more)*this.share*4);t.bindBuffer(t.ARRAY_BUFFER,this.pointsOf(i)),t.getBufferSubData(t.ARRAY_BUFFER,0,r),t.bindBuffer(t.ARRAY_BUFFER,null);for(let a=i.firstItem;a<i.firstItem+i.items;++a){if(n[4*a+2]>>>8)continue;let s=n[4*a+2]&63,u=(n[4*a+2]&128)!==0,l=4*this.share*(a-i.firstItem);yield[n[4*a],r.subarray(l,l+4*(s+(u?0:1))),(n[4*a+2]&64)!==0]}}}blocksOf(e){let t=this.toItems;return n=>{for(let i=n.firstItem;i<n.firstItem+n.items;++i)if(t[4*i]===e)return!0;return!1}}world(e,t){return[0,1,2].map(n=>this.toData[12+n]+e[4*t+n])}pointsOfStreamline(e){let t=[];for(let[n,i]of this.decoded(this.blocksOf(e)))if(n===e)for(let r=0;4*r<i.length;++r)t.push(this.world(i,r));return t}through(e,t){let n=new Uint8Array(this.streamlines),i=[0,1,2].map(s=>e[s]-this.toData[12+s]),r=t*t,a=s=>[0,1,2].every(u=>e[u]+t>=s.bounds[2*u]&&e[u]-t<=s.bounds[2*u+1]);for(let[s,u]of this.decoded(a))if(!n[s])for(let l=0;l<u.length;l+=4){let d=Math.min(l+4,u.length-4),f=u[d]-u[l],v=u[d+1]-u[l+1],p=u[d+2]-u[l+2],w=i[0]-u[l],b=i[1]-u[l+1],_=i[2]-u[l+2],T=Math.min(1,Math.max(0,(w*f+b*v+_*p)/(f*f+v*v+p*p||1))),E=w-T*f,A=b-T*v,R=_-T*p;if(E*E+A*A+R*R<=r){n[s]=1;break}}return n}release(){let e=this.gl;for(let t of this.blocks)t.buffer&&e.deleteBuffer(t.buffer);for(let t of Object.values(this.textures))e.deleteTexture(t);this.scratch&&e.deleteBuffer(this.scratch),e.deleteBuffer(this.itemBuffer)}};function on(o,e,t){let n=e.slice(0,6).map(i=>[0,1,2,3].map(r=>i[0]*t[4*r]+i[1]*t[4*r+1]+i[2]*t[4*r+2]+i[3]*t[4*r+3]));o.ints({plane_count:n.length}),n.forEach((i,r)=>o.set({[`planes[${r}]`]:i}))}var fe=class{constructor(e,t,n){c(this,"gl",e);c(this,"layer",t);c(this,"array");c(this,"buffers",[]);c(this,"count");c(this,"table",null);c(this,"tableRange",[0,1,1,1]);c(this,"model");this.model=new Float64Array(t.matrix??[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]),this.array=e.createVertexArray(),e.bindVertexArray(this.array);let i=(a,s,u,l,d)=>{let f=e.createBuffer();e.bindBuffer(e.ARRAY_BUFFER,f),e.bufferData(e.ARRAY_BUFFER,s,e.STATIC_DRAW),e.enableVertexAttribArray(a),e.vertexAttribPointer(a,u,l,d,0,0),this.buffers.push(f)};i(0,n[t.places],3,e.FLOAT,!1),t.normals!==void 0&&i(1,n[t.normals],3,e.FLOAT,!1),t.colours!==void 0&&i(2,n[t.colours],4,e.UNSIGNED_BYTE,!0),t.values!==void 0&&(i(3,n[t.values],1,e.FLOAT,!1),[this.table,this.tableRange]=le(e,k(t.table),t.clim,!!t.log));let r=e.createBuffer();e.bindBuffer(e.ELEMENT_ARRAY_BUFFER,r),e.bufferData(e.ELEMENT_ARRAY_BUFFER,n[t.triangles],e.STATIC_DRAW),this.buffers.push(r),this.count=n[t.triangles].byteLength/4,e.bindVertexArray(null)}get translucent(){return this.layer.opacity<1}draw(e,t){let n=this.gl,{layer:i}=this,r=F(t.view,this.model),a=$(r),s=Z(r),u=s?[s[0],s[4],s[8],s[1],s[5],s[9],s[2],s[6],s[10]]:a;e.use().set({clip_from_data:se(F(t.projection,r)),view_from_data:se(r),normal_to_view:u,parallel:t.parallel?1:0,opacity:i.opacity,reflects:i.reflects,sheen:i.sheen}),e.ints({smooth_normals:i.normals===void 0?0:1,lighting:i.lighting?1:0,by_value:this.table?1:0,logarithm:i.log?1:0}),e.textures({table:this.table}).set({table_range:this.tableRange}),t.lights(e),on(e,[...i.planes??[],...t.planes],this.model),n.bindVertexArray(this.array),i.normals===void 0&&n.vertexAttrib3f(1,0,0,1),i.colours===void 0&&n.vertexAttrib4f(2,i.colour[0],i.colour[1],i.colour[2],1),n.drawElements(n.TRIANGLES,this.count,n.UNSIGNED_INT,0),n.bindVertexArray(null)}depth(e){let t=this.layer.bounds,n=[(t[0]+t[1])/2,(t[2]+t[3])/2,(t[4]+t[5])/2];return-(e[2]*n[0]+e[6]*n[1]+e[10]*n[2]+e[14])}},de=class{constructor(e,t,n){c(this,"gl",e);c(this,"layer",t);c(this,"texture");let[i,r]=t.size;this.texture=e.createTexture(),e.bindTexture(e.TEXTURE_2D,this.texture),e.texImage2D(e.TEXTURE_2D,0,e.RGBA8,i,r,0,e.RGBA,e.UNSIGNED_BYTE,n[t.pixels]);for(let a of["TEXTURE_MIN_FILTER","TEXTURE_MAG_FILTER"])e.texParameteri(e.TEXTURE_2D,e[a],e.NEAREST);for(let a of["TEXTURE_WRAP_S","TEXTURE_WRAP_T"])e.texParameteri(e.TEXTURE_2D,e[a],e.CLAMP_TO_EDGE)}draw(e,t){let{layer:n}=this;e.use().set({clip_from_data:se(F(t.projection,t.view)),corner:n.corner,across:n.across,up:n.up,opacity:n.opacity}),e.textures({pixels:this.texture}),this.gl.bindVertexArray(null),this.gl.drawArrays(this.gl.TRIANGLE_STRIP,0,4)}};var sn=60,De=45,un=400,ln=40,re=4294967295,cn={direction:0,solid:1,streamline:2,value:3,point:4},fn={none:0,line:1,illuminated:2},ge=class{constructor(e,t,n,i){c(this,"gl",e);c(this,"layer",t);c(this,"index",n);c(this,"set");c(this,"model");c(this,"values",null);c(this,"colours",null);c(this,"table",null);c(this,"tableRange",[0,1,1,1]);c(this,"kept",null);c(this,"shownValues",[1,0]);c(this,"marked",re);this.set=new ce(e,Be(i[t.data])),this.model=new Float64Array(t.matrix??me());let{colours:r}=t;r.values!==void 0&&(this.values=this.set.pointValues(r.values)),r.data!==void 0&&(this.colours=B(e,"rgba8",i[r.data],"colours")),r.table!==void 0&&([this.table,this.tableRange]=le(e,k(r.table),r.clim,!!r.log)),t.kept!==void 0&&this.keep(i[t.kept])}get byPoint(){return this.layer.colours.mode==="point"}keep(e){this.kept&&this.gl.deleteTexture(this.kept),this.kept=e&&B(this.gl,"r8ui",e,"streamlines")}},he=class{constructor(e,t,n){c(this,"canvas",e);c(this,"scene",t);c(this,"data",n);c(this,"camera");c(this,"lines",[]);c(this,"surfaces",[]);c(this,"images",[]);c(this,"planes",[]);c(this,"width",0);c(this,"height",0);c(this,"ratio",1);c(this,"frames",0);c(this,"failed",null);c(this,"drawnOnce",null);c(this,"presented",null);c(this,"gl");c(this,"programs",new Map);c(this,"frameBlock");c(this,"clipBlock");c(this,"textures",{});c(this,"buffers",{});c(this,"frame",null);c(this,"sync",null);c(this,"sliceStarted",0);c(this,"sliceSize",0);c(this,"rate",1e3);c(this,"dirty",!0);c(this,"moving",!1);c(this,"asked",0);c(this,"still",0);c(this,"waiting",[]);c(this,"restored",null);this.camera=new oe(structuredClone(t.camera));let i=e.getContext("webgl2",{alpha:!1,antialias:!1,depth:!1,preserveDrawingBuffer:!1,powerPreference:"high-performance"});if(!i)throw new H("This browser has no WebGL 2, which the page draws with. Turn on graphics acceleration in its settings, or open the page in another browser.");this.gl=i,e.addEventListener("webglcontextlost",r=>{r.preventDefault(),this.frame=null,this.sync=null}),e.addEventListener("webglcontextrestored",()=>this.guarded(()=>this.begin())),this.begin()}guarded(e){try{e()}catch(t){this.gl.isContextLost()||this.failed?.(t)}}begin(){let{gl:e,scene:t}=this,n=this.lines.splice(0);this.programs.clear(),this.textures={},this.buffers={},this.width=this.height=0,this.surfaces.length=this.images.length=0,this.frameBlock=new U(e,"Frame"),this.clipBlock=new U(e,"ClipPlanes"),t.layers.forEach(r=>{r.kind==="surface"?this.surfaces.push(new fe(e,r,this.data)):r.kind==="image"?this.images.push(new de(e,r,this.data)):this.lines.push(new ge(e,r,this.lines.length,this.data))});let i=Math.min(1024,128*(navigator.deviceMemory??4))*2**20;for(let r of this.lines)r.set.budget=i/this.lines.length;n.forEach((r,a)=>{let s=this.lines[a];s.shownValues=r.shownValues,s.marked=r.marked}),this.restored?.(),this.change()}program(e,t,n=[]){let i=[e,t,...n].join(" "),r=this.programs.get(i);return r||this.programs.set(i,r=new W(this.gl,e,t,n)),r}change(e=!1){this.dirty=!0,this.moving=e,window.clearTimeout(this.still),e&&(this.still=window.setTimeout(()=>this.change(),200)),this.schedule()}schedule(){this.asked||(this.asked=requestAnimationFrame(()=>this.guarded(()=>this.tick())))}settled(){return!this.dirty&&!this.frame?Promise.resolve():new Promise(e=>this.waiting.push(e))}tick(){this.asked=0;let{gl:e}=this;if(e.isContextLost())return;if(this.sync){if(e.getSyncParameter(this.sync,e.SYNC_STATUS)!==e.SIGNALED)return this.schedule();e.deleteSync(this.sync),this.sync=null;let r=Math.max(performance.now()-this.sliceStarted,.5);this.sliceSize>2e3&&(this.rate+=.5*(Math.min(this.sliceSize/r,8*this.rate)-this.rate))}this.fit(),this.dirty&&this.start();let t=this.frame;if(!t)return;let n=this.rate*(t.moving?De:sn);this.sliceStarted=performance.now(),this.sliceSize=0,this.drawSlice(t,t.moving?1/0:n);let i=t.next>=t.jobs.length;(i||performance.now()-t.shownAt>un)&&(t.shownAt=performance.now(),this.present(t.matrices,i),this.drawnOnce&&(this.drawnOnce(),this.drawnOnce=null)),this.sync=e.fenceSync(e.SYNC_GPU_COMMANDS_COMPLETE,0),e.flush(),i&&(this.frame=null,++this.frames,!t.moving&&!this.dirty&&this.waiting.splice(0).forEach(r=>r())),this.schedule()}fit(){let{gl:e,canvas:t}=this,n=window.devicePixelRatio||1,i=e.getParameter(e.MAX_TEXTURE_SIZE)-2,r=Math.min(i,Math.max(1,Math.round(t.clientWidth*n))),a=Math.min(i,Math.max(1,Math.round(t.clientHeight*n)));if(r===this.width&&a===this.height)return;t.width=this.width=r,t.height=this.height=a,this.ratio=n;for(let u of Object.values(this.textures))e.deleteTexture(u);for(let u of Object.values(this.buffers))e.deleteFramebuffer(u);let s=this.textures={texels:ne(e,e.RGBA32UI,r,a),depths:ne(e,e.DEPTH_COMPONENT32F,r,a),drawn:ne(e,e.RGBA8,r,a),shown:ne(e,e.RGBA32UI,r+2,a+2)};this.buffers={texels:te(e,s.texels,s.depths),scene:te(e,s.drawn,s.depths),drawn:te(e,s.drawn,null),shown:te(e,s.shown,null)},this.dirty=!0}start(){let{gl:e,camera:t,scene:n}=this,i=this.moving;this.dirty=!1;let r=t.view(),a=t.projection(this.width/this.height,n.bounds),s={view:r,projection:a,parallel:t.state.parallel,lights:f=>this.setLights(f,r),planes:this.planes},u=[],l=0;for(let f of this.lines)if(f.layer.visible)for(let v of f.set.blocks)this.outside(F(a,F(r,f.model)),v.bounds)||(u.push({lines:f,block:v}),l+=f.set.instances(v));let d=i?Math.min(1,this.rate*De/Math.max(l,1)):1;this.frame={jobs:u,next:0,share:d,drawn:0,shownAt:performance.now(),matrices:s,moving:i},this.frames||(this.frame.shownAt=0),e.viewport(0,0,this.width,this.height),e.disable(e.BLEND),e.disable(e.CULL_FACE),e.bindFramebuffer(e.FRAMEBUFFER,this.buffers.texels),e.clearBufferuiv(e.COLOR,0,[re,re,0,0]),e.depthMask(!0),e.clearBufferfv(e.DEPTH,0,[1]),this.drawBackdrop(s)}drawBackdrop(e){let{gl:t,scene:n}=this;t.bindFramebuffer(t.FRAMEBUFFER,this.buffers.scene),t.disable(t.DEPTH_TEST),t.bindVertexArray(null),this.program("page/screen.vert","page/background.frag").use().set({bottom:n.background[0],top:n.background[1],height:this.height}),t.drawArrays(t.TRIANGLES,0,3),t.enable(t.DEPTH_TEST),t.depthFunc(t.LEQUAL),t.depthMask(!0);let i=this.program("page/surface.vert","page/surface.frag");for(let a of this.surfaces)a.layer.visible&&!a.translucent&&a.draw(i,e);let r=this.program("page/image.vert","page/image.frag");for(let a of this.images)a.layer.visible&&a.layer.opacity>=1&&a.draw(r,e)}outside(e,t){let n=[0,0,0,0,0,0];for(let i=0;i<8;++i){let[r,a,s,u]=O(e,[t[i&1],t[2+(i>>1&1)],t[4+(i>>2)]]);[r<-u,r>u,a<-u,a>u,s<-u,s>u].forEach((l,d)=>n[d]+=l?1:0)}return n.some(i=>i===8)}setLights(e,t){let n=[0,0,0],i=0;this.scene.lights.slice(0,8).forEach((r,a)=>{let s=[0,0,1,0];r.view?s=[...r.view,0]:r.world&&(i=1,s=O(t,r.world,r.positional?1:0),s[3]=r.positional?1:0),e.set({[`light_colour[${a}]`]:r.colour,[`light_place[${a}]`]:s}),r.colour.forEach((u,l)=>n[l]+=u)}),e.ints({light_count:Math.min(this.scene.lights.length,8)}).set({light_sum:n,light_standing:i})}aim(e,t){let n=e.layer.line_width*this.ratio,i=n>1,r=F(t.view,F(e.model,e.set.toData)),a=F(t.projection,r),s=a.reduce((d,f)=>Math.max(d,Math.abs(f)),0)||1,u=new Float64Array(16);for(let d=0;d<4;++d){let[f,v,p,w]=[0,1,2,3].map(b=>a[b+4*d]/s);u.set([this.width/2*(f+w),this.height/2*(v+w),(p+w)/2,w],4*d)}this.frameBlock.write({window_from_local:u,reference:e.set.reference,half_line_width:i?n/2:0,viewport:[this.width,this.height]},["reference"]),this.frameBlock.bind();let l=[...e.layer.planes??[],...this.planes].slice(0,8);if(l.length){let d=F(e.model,e.set.toData),f=Z(a),v=new Float64Array(32),p=new Float64Array(32);l.forEach((w,b)=>{let _=[0,1,2,3].map(E=>w[0]*d[4*E]+w[1]*d[4*E+1]+w[2]*d[4*E+2]+w[3]*d[4*E+3]),T=Math.hypot(_[0],_[1],_[2])||1;if(_.forEach((E,A)=>v[4*b+A]=E/T),f)for(let E=0;E<2;++E){let A=[0,1,2,3].reduce((R,m)=>R+v[4*b+m]*f[m+4*E],0);p[4*b+E]=A*s*(2/(E===0?this.width:this.height))}}),this.clipBlock.write({clip_planes:v,clip_tilts:p,clip_plane_count:0,clip_rounding:0}),this.clipBlock.write({clip_plane_count:l.length},["clip_plane_count"]),this.clipBlock.bind()}return{wide:i,clipped:l.length>0}}pixelsOf(e,t,n){let i=F(t.projection,F(t.view,e.model)),r=e.set.bounds,a=Math.hypot(...$(e.model)),s=1/0;for(let u=0;u<8;++u)s=Math.min(s,O(i,[r[u&1],r[2+(u>>1&1)],r[4+(u>>2)]])[3]);return s>0?n*a*(this.height/2)*t.projection[5]/s:1/0}drawSlice(e,t){let{gl:n}=this,i=null,r=null,a=!1;for(;e.next<e.jobs.length&&this.sliceSize<t;){let{lines:s,block:u}=e.jobs[e.next++];if(s.set.pointsOf(u),i!==s){i=s;let{wide:l,clipped:d}=this.aim(s,e.matrices),f=["CLIPPING","CLIPPING_DEPTH","EDGES"];l&&f.push("WIDE_LINES"),d&&f.push("CLIP_PLANES"),a=!l&&this.pixelsOf(s,e.matrices,s.set.longestStep)<=ln,a&&f.push("SPRITES"),s.values&&f.push("VALUES_STORED"),s.byPoint&&f.push("VALUES_COLOUR"),s.kept&&f.push("STREAMLINE_MASK"),r=this.program("page/segment.vert","page/segment.frag",f).use(),s.values&&r.set({value_code:s.values.code,shown_values:s.shownValues}),r.uints({layer:s.index*2**28})}n.bindFramebuffer(n.FRAMEBUFFER,this.buffers.texels),n.enable(n.DEPTH_TEST),n.depthFunc(n.LESS),this.frameBlock.bind(),r.use().textures({items:s.set.items,kept:s.kept,value_texels:s.values&&s.values.texture,point_colours:s.byPoint?s.colours:null}),this.sliceSize+=s.set.draw(u,r,e.share,a)}}present(e,t){let{gl:n,textures:i,buffers:r}=this;this.repaint(e),n.disable(n.DEPTH_TEST),n.bindFramebuffer(n.FRAMEBUFFER,r.drawn),n.bindVertexArray(null);let a=this.program("page/screen.vert","page/resolve.frag").use(),s=Z(e.projection)??me(),u=0;for(let l of this.lines){if(!l.layer.visible)continue;let{layer:d}=l,{colours:f}=d,v=d.line_width*this.ratio;u=Math.max(u,1-Math.min(1,v)),a.textures({texels:i.texels,depths:i.depths,colours:l.byPoint?null:l.colours,table:l.table}),a.uints({layer:l.index*2**28,marked:l.marked}),a.ints({mode:cn[f.mode],logarithm:f.log?1:0,light:fn[d.light]}),a.set({one_colour:f.colour??[1,1,1],table_range:l.tableRange,reflects:d.reflects,sheen:d.sheen,data_to_view:$(F(e.view,l.model)),pixel_to_view:new Float32Array(s),picture:[this.width,this.height]}),this.setLights(a,e.view),n.drawArrays(n.TRIANGLES,0,3)}if(this.drawTranslucent(e),n.disable(n.DEPTH_TEST),n.bindVertexArray(null),t&&this.scene.antialias&&this.lines.length){n.bindFramebuffer(n.FRAMEBUFFER,r.shown),n.viewport(0,0,this.width+2,this.height+2),this.program("page/screen.vert","page/visible_edges.frag").use().textures({texels:i.texels,depths:i.depths,drawn:i.drawn}).set({narrower:u}),n.drawArrays(n.TRIANGLES,0,3),n.viewport(0,0,this.width,this.height),n.bindFramebuffer(n.FRAMEBUFFER,r.drawn);let l=this.program("page/screen.vert","effects/picture/antialias_coverage.frag").use().textures({shown:i.shown});n.uniform2i(l.at("shift"),1,1),n.drawArrays(n.TRIANGLES,0,3)}n.bindFramebuffer(n.FRAMEBUFFER,null),this.program("page/screen.vert","page/copy.frag").use().textures({drawn:i.drawn}),n.drawArrays(n.TRIANGLES,0,3),this.presented?.()}repaint(e){this.frame&&this.frame.drawn++>0&&this.drawBackdrop(e)}drawTranslucent(e){let{gl:t}=this,n=this.surfaces.filter(s=>s.layer.visible&&s.translucent),i=this.images.filter(s=>s.layer.visible&&s.layer.opacity<1);if(!n.length&&!i.length)return;t.bindFramebuffer(t.FRAMEBUFFER,this.buffers.scene),t.enable(t.DEPTH_TEST),t.depthFunc(t.LEQUAL),t.depthMask(!1),t.enable(t.BLEND),t.blendFunc(t.SRC_ALPHA,t.ONE_MINUS_SRC_ALPHA);let r=this.program("page/surface.vert","page/surface.frag");n.sort((s,u)=>u.depth(e.view)-s.depth(e.view)).forEach(s=>s.draw(r,e));let a=this.program("page/image.vert","page/image.frag");i.forEach(s=>s.draw(a,e)),t.disable(t.BLEND),t.depthMask(!0)}pick(e,t){let{gl:n}=this,i=Math.floor(e*this.ratio),r=this.height-1-Math.floor(t*this.ratio),a=new Uint32Array(4),s=[[0,0],[1,0],[-1,0],[0,1],[0,-1],[2,0],[-2,0],[0,2],[0,-2]];for(let[u,l]of s){if(i+u<0||r+l<0||i+u>=this.width||r+l>=this.height||(n.bindFramebuffer(n.FRAMEBUFFER,this.buffers.texels),n.readPixels(i+u,r+l,1,1,n.RGBA_INTEGER,n.UNSIGNED_INT,a),a[0]===re&&a[1]===re))continue;let d=this.lines[a[0]>>>28];if(!d)continue;let f=d.values?new Float32Array(new Uint32Array([a[3]]).buffer)[0]:null;return{lines:d,streamline:a[0]&268435455,value:f}}return null}placeOf(e,t,n,i){let{camera:r,scene:a,canvas:s}=this,u=s.clientWidth,l=s.clientHeight,d=F(r.projection(this.width/this.height,a.bounds),F(r.view(),e.model)),f=[0,0,0],v=1/0;for(let p of e.set.pointsOfStreamline(t)){let[w,b,,_]=O(d,p),T=Math.hypot((w/_+1)*u/2-n,(1-b/_)*l/2-i);_>0&&T<v&&([f,v]=[p,T])}return f}pixels(){let{gl:e,width:t,height:n}=this,i=new Uint8Array(4*t*n),r=new Uint8Array(i.length);e.bindFramebuffer(e.FRAMEBUFFER,this.buffers.drawn),e.readPixels(0,0,t,n,e.RGBA,e.UNSIGNED_BYTE,i);for(let a=0;a<n;++a)r.set(i.subarray(4*t*a,4*t*(a+1)),4*t*(n-1-a));return r}};var Ce=o=>document.getElementById(o)?.textContent??"";async function dn(o){return Promise.all(o.data.map(async(e,t)=>{if(e.file===void 0)return k(Ce(`data-${t}`).trim());let n=await fetch(e.file);if(!n.ok)throw new Error(`${e.file} cannot be read (${n.status}); it must lie beside this page.`);return new Uint8Array(await n.arrayBuffer())}))}function Ue(o){let e=document.getElementById("message");e.textContent=o instanceof Error?o.message:String(o),e.hidden=!1,document.body.dataset.state="failed"}async function hn(){let o=JSON.parse(Ce("scene"));document.title=o.title;let e=await dn(o),t=new he(document.getElementById("view"),o,e);t.failed=Ue,t.drawnOnce=()=>{document.body.dataset.state="drawn"},new ResizeObserver(()=>t.change()).observe(t.canvas);let n=new ue(t,e);Re(t,(i,r)=>n.pick(i,r)),window.pvfiblets=t}hn().catch(Ue);})();
